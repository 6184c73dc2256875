// The parameters of glTF materials that shape specular lobes, and the lobes they make.
#pragma once

#include <tiny_gltf.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/scene_use.h"

namespace ltcfit {

/// A use of a texture, with KHR_texture_transform.
struct TextureUse {
  int texture = -1;  ///< none
  int texCoord = 0;
  std::array<double, 2> offset{0.0, 0.0};
  double rotation = 0.0;  ///< radians
  std::array<double, 2> scale{1.0, 1.0};

  std::array<double, 2> transformed(const std::array<double, 2>& uv) const;
  bool operator==(const TextureUse&) const = default;
};

/// The textures that a lobe can depend on.
enum TextureSlot : std::size_t {
  kMetallicRoughness,
  kBaseColor,
  kAnisotropy,
  kSpecular,
  kSpecularColor,
  kSpecularGlossiness,
  kClearcoat,
  kClearcoatRoughness,
  kTextureSlots
};

/// How texels are read of each, 8 bits a channel; where there is no texture all channels are 255.
using SlotTexels = std::array<std::array<std::uint8_t, 4>, kTextureSlots>;

/// The channels of a slot that the functions below read, 0 to 3 for red to alpha.
std::span<const std::size_t> channelsOf(TextureSlot slot);

/// Factors as the file has them, clamped to what glTF allows.
struct GltfMaterial {
  std::string name;
  double roughness = 1.0;
  double metallic = 1.0;
  std::array<double, 3> baseColor{1.0, 1.0, 1.0};
  double anisotropy = 0.0;                             ///< KHR_materials_anisotropy, strength
  double ior = 1.5;                                    ///< KHR_materials_ior
  double specular = 1.0;                               ///< KHR_materials_specular
  std::array<double, 3> specularColor{1.0, 1.0, 1.0};  ///< may exceed 1
  double clearcoat = 0.0;                              ///< KHR_materials_clearcoat
  double clearcoatRoughness = 0.0;
  bool specularGlossiness =
      false;  ///< KHR_materials_pbrSpecularGlossiness in place of the above but the coat
  std::array<double, 3> reflectance{1.0, 1.0, 1.0};
  double glossiness = 1.0;
  bool unlit = false;  ///< KHR_materials_unlit
  std::array<TextureUse, kTextureSlots> textures;

  bool emits = false;  ///< emissiveFactor times KHR_materials_emissive_strength is not black
  bool emissiveTexture = false;
  bool doubleSided = false;
};

/// Reads a material. A factor out of its range is clamped with a sentence in `notes`, which also gets one for
/// each extension whose light GGX tables do not hold (sheen, transmission, iridescence, ...). InputError,
/// naming the material, for fields of a wrong type.
GltfMaterial materialFrom(const tinygltf::Material& material, const std::string& name,
                          std::vector<std::string>& notes);

/// The slots on which the lobe of the base (or the coat) depends: textures whose factors are 0 are left out.
std::vector<TextureSlot> slotsOfBase(const GltfMaterial& material);
std::vector<TextureSlot> slotsOfCoat(const GltfMaterial& material);

/// glTF 2.0, appendix B, and the extensions above: alphaY = roughness^2, alphaX = mix(alphaY, 1, strength^2);
/// the luminance of f0 and f90 mixed by metallic between a dielectric's and the base colour. Weight 0.
LobeUse baseLobe(const GltfMaterial& material, const SlotTexels& texels);
/// Isotropic, f0 of index 1.5. Only where clearcoatAt is more than 0.
LobeUse coatLobe(const GltfMaterial& material, const SlotTexels& texels);
double clearcoatAt(const GltfMaterial& material, const SlotTexels& texels);

}  // namespace ltcfit
