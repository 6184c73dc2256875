// The textures of a glTF scene, and the lobes that they and the factors of a material make.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/gltf_accessor.h"
#include "scene/gltf_file.h"
#include "scene/gltf_material.h"
#include "scene/gltf_surfaces.h"
#include "scene/texel_image.h"
#include "scene/uv_coverage.h"

namespace ltcfit {

/// Texels that the materials of one file may have counted, and that coverage may visit: they bound the time
/// that many materials with one large image take.
inline constexpr std::size_t kMaxCountedTexels = std::size_t{1} << 32;
inline constexpr std::size_t kMaxCoverageWork = std::size_t{1} << 30;

/// A texture of a material, ready to be looked up.
struct LoadedTexture {
  std::shared_ptr<const TexelImage> image;
  std::string name;
  std::string assumed;  ///< why `image` is uniformTexels instead; empty: it is not
  Wrap wrapU = Wrap::kRepeat;
  Wrap wrapV = Wrap::kRepeat;
};

/// Loads images when first asked for.
class GltfTextures {
 public:
  /// `file` and `accessors` must outlive this.
  GltfTextures(const GltfFile& file, GltfAccessors& accessors) : file_(file), accessors_(accessors) {}

  /// Calls `count` with the texels that `slots` of `material` show together, and with the area that shows
  /// them, up to a factor that is the same in one call. `surfaces` are the material's. Areas are equal, and
  /// all texels counted, where texture coordinates cannot be read; triangles count alike where their areas
  /// are all 0. Slots with the same mapping of texture coordinates are looked up together, at the texels of
  /// the largest of their images; those of unlike mappings are independent: every combination of values
  /// counts, by the product of their areas (texel_values.h, with what it merges where they are too many).
  /// Returns how many texels of one image were counted, 0 without slots and where no image could be read, and
  /// appends a sentence for each texture to `reasons`. InputError for images as decodeTexels and imageBytes,
  /// for texture indices out of range, and past kMaxCountedTexels.
  std::size_t forEachTexel(const GltfMaterial& material, const std::vector<TextureSlot>& slots,
                           const std::vector<const GltfSurface*>& surfaces, std::vector<std::string>& reasons,
                           const std::function<void(const SlotTexels&, double area)>& count);

 private:
  /// Textures that are looked up at the same places.
  struct Group {
    TextureUse mapping;  // of its first slot
    std::vector<TextureSlot> slots;
    std::vector<LoadedTexture> textures;
    std::size_t reference = 0;  // the largest image
    std::vector<float> areas;   // of its texels; empty: all alike
    std::size_t shown = 0;      // of them, that have an area

    const LoadedTexture& largest() const { return textures[reference]; }
    std::size_t texels() const { return areas.empty() ? largest().image->texels.size() : shown; }
  };

  LoadedTexture load(int texture, const std::string& material);
  std::vector<Group> groupsOf(const GltfMaterial& material, const std::vector<TextureSlot>& slots);
  std::string cover(Group& group, const std::vector<const GltfSurface*>& surfaces);
  static void explain(const Group& group, const std::string& uncovered, std::vector<std::string>& reasons);
  static void forEachShown(const Group& group, const std::function<void(const SlotTexels&, double)>& visit);
  void spend(std::size_t texels);

  const GltfFile& file_;
  GltfAccessors& accessors_;
  std::map<std::size_t, std::shared_ptr<const TexelImage>> images_;
  std::size_t decodedTexels_ = 0;
  std::size_t countedTexels_ = 0;
  std::size_t coverageWork_ = 0;
};

}  // namespace ltcfit
