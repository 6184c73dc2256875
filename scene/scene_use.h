// What a scene uses of the tables: which lobes, under which lights. Readers of scenes fill it, the plan
// (tailor/scene_plan.h) follows from it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace ltcfit {

/// A GGX lobe that occurs in the scene.
struct LobeUse {
  double alphaX = 1.0;  ///< the larger GGX alpha (not its root), 0..1
  double alphaY = 1.0;  ///< the smaller one, 0..alphaX; equal: isotropic
  double f0 = 1.0;      ///< luminance of the reflectance at normal incidence, 0..1
  double f90 = 1.0;     ///< at grazing incidence, 0..1
  /// Share of the scene's surface area that has it. Where areas are not known all materials count alike.
  double weight = 0.0;
};

/// One specular lobe of one material.
struct MaterialUse {
  std::string name;            ///< of the material, with ", clearcoat" for its coat
  double area = 0.0;           ///< share of the scene's surface area, 0..1
  bool textured = false;       ///< some of its parameters come from a texture
  std::size_t texels = 0;      ///< counted for that
  std::vector<LobeUse> lobes;  ///< distinct; weights add up to `area`
  /// Where the numbers come from, and what was assumed: a sentence each.
  std::vector<std::string> reasons;
};

/// Area lights of the scene, by kind.
struct LightUse {
  bool polygon = false;
  bool disk = false;
  bool sphere = false;
  bool textured = false;
  bool oneSided = false;
  bool twoSided = false;
  std::vector<std::string> reasons;

  bool any() const { return polygon || disk || sphere || textured; }
};

/// Range of the view angle from the normal, radians.
struct ViewUse {
  double low = 0.0;
  double high = 1.5707963267948966;
};

struct SceneUse {
  std::string name;  ///< the file's, without folder
  std::vector<MaterialUse> materials;
  LightUse lights;
  ViewUse views;
  /// What a user should know: unused materials, extensions that LTC tables do not cover, textures that could
  /// not be read and what was assumed instead.
  std::vector<std::string> notes;
  std::size_t lobeCount = 0;  ///< of all materials, as addMaterial counts
};

/// Memory that the lobes of one scene may take: those of some two thousand materials with as many lobes as
/// LobeHistogram keeps.
inline constexpr std::size_t kMaxLobeBytes = std::size_t{340} << 20;

/// Appends `material`. InputError, naming it and the number of bytes, where the lobes of all would take more
/// than `maxBytes`: a small file may have a hundred thousand materials.
void addMaterial(SceneUse& use, MaterialUse material, std::size_t maxBytes = kMaxLobeBytes);

}  // namespace ltcfit
