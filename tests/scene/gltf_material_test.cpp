// Factors and texels of glTF materials become lobes: numbers worked out by hand.
#include "scene/gltf_material.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "export/atomic_file.h"
#include "scene/gltf_file.h"
#include "tests/scene/gltf_builder.h"

namespace ltcfit {
namespace {

using test::GltfBuilder;
using test::GltfJson;

// products and sums of a few rounded numbers
constexpr double kRounding = 1e-12;

struct Read {
  GltfMaterial material;
  std::vector<std::string> notes;
};

Read read(const GltfJson& json) {
  GltfBuilder builder;
  builder.material(json);
  const GltfFile file = parseGltf(builder.glb(), {});
  Read out;
  out.material = materialFrom(file.model.materials.at(0), "m", out.notes);
  return out;
}

SlotTexels white() {
  SlotTexels texels;
  for (auto& texel : texels) texel.fill(255);
  return texels;
}

TEST(GltfMaterial, DefaultIsRoughWhiteMetal) {
  const LobeUse lobe = baseLobe(read(GltfJson::object()).material, white());
  EXPECT_EQ(lobe.alphaX, 1.0);
  EXPECT_EQ(lobe.alphaY, 1.0);
  EXPECT_NEAR(lobe.f0, 1.0, kRounding);
  EXPECT_EQ(lobe.f90, 1.0);
}

TEST(GltfMaterial, AlphaIsSquaredRoughness) {
  const Read m = read({{"pbrMetallicRoughness", {{"roughnessFactor", 0.4}, {"metallicFactor", 0.0}}}});
  const LobeUse lobe = baseLobe(m.material, white());
  EXPECT_NEAR(lobe.alphaX, 0.16, kRounding);
  EXPECT_EQ(lobe.alphaX, lobe.alphaY);
  EXPECT_NEAR(lobe.f0, 0.04, kRounding);
  EXPECT_EQ(lobe.f90, 1.0);
  EXPECT_TRUE(m.notes.empty());
}

TEST(GltfMaterial, RoughnessIsGreenAndMetallicBlue) {
  const Read m = read({{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}, {"metallicFactor", 0.5}}}});
  SlotTexels texels = white();
  texels[kMetallicRoughness] = {255, 51, 102, 255};  // 0.2, 0.4
  const LobeUse lobe = baseLobe(m.material, texels);
  EXPECT_NEAR(lobe.alphaY, 0.01, kRounding);          // (0.5 * 0.2)^2
  EXPECT_NEAR(lobe.f0, 0.04 * 0.8 + 0.2, kRounding);  // metallic 0.2, white
}

TEST(GltfMaterial, MetalReflectsTheLuminanceOfItsColour) {
  const Read m = read({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 1.0, 0.25, 1.0}}}}});
  SlotTexels texels = white();
  texels[kBaseColor] = {255, 188, 0, 10};  // sRGB 188 is 0.502886 linear
  EXPECT_NEAR(baseLobe(m.material, texels).f0, 0.2126 * 0.5 + 0.7152 * 0.502886, 1e-6);  // the digits given
}

TEST(GltfMaterial, AnisotropyRaisesOneAlphaByItsSquare) {
  const Read m =
      read({{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}},
            {"extensions",
             {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 1.0}}}}}});
  SlotTexels texels = white();
  const LobeUse full = baseLobe(m.material, texels);
  EXPECT_NEAR(full.alphaY, 0.25, kRounding);
  EXPECT_NEAR(full.alphaX, 0.25 * 0.64 + 0.36, kRounding);  // mix(0.25, 1, 0.36)
  texels[kAnisotropy] = {0, 0, 51, 0};                      // 0.2 of it
  EXPECT_NEAR(baseLobe(m.material, texels).alphaX, 0.25 + 0.75 * 0.0144, kRounding);
}

TEST(GltfMaterial, IndexOfRefractionAndSpecular) {
  const GltfJson dielectric{{"metallicFactor", 0.0}};
  const auto lobe = [&](const GltfJson& extensions, const SlotTexels& texels) {
    return baseLobe(read({{"pbrMetallicRoughness", dielectric}, {"extensions", extensions}}).material,
                    texels);
  };
  EXPECT_NEAR(lobe({{"KHR_materials_ior", {{"ior", 2.0}}}}, white()).f0, 1.0 / 9.0, kRounding);
  EXPECT_NEAR(lobe({{"KHR_materials_ior", {{"ior", 0.0}}}}, white()).f0, 1.0, kRounding);
  EXPECT_NEAR(lobe({{"KHR_materials_ior", {{"ior", 1.0}}}}, white()).f0, 0.0, kRounding);

  const GltfJson half{{"KHR_materials_specular", {{"specularFactor", 0.5}}}};
  EXPECT_NEAR(lobe(half, white()).f0, 0.02, kRounding);
  EXPECT_NEAR(lobe(half, white()).f90, 0.5, kRounding);
  SlotTexels texels = white();
  texels[kSpecular] = {1, 2, 3, 51};  // 0.2 of it
  EXPECT_NEAR(lobe(half, texels).f0, 0.004, kRounding);
  EXPECT_NEAR(lobe(half, texels).f90, 0.1, kRounding);

  // red 0.04 * 30 is clamped to 1 before the factor, green is left as it is
  const GltfJson colored{
      {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {30.0, 2.0, 0.0}}}}};
  EXPECT_NEAR(lobe(colored, white()).f0, 0.5 * (0.2126 * 1.0 + 0.7152 * 0.08), kRounding);
  texels = white();
  texels[kSpecularColor] = {0, 188, 255, 0};
  EXPECT_NEAR(lobe(colored, texels).f0, 0.5 * 0.7152 * 0.08 * 0.502886, 1e-7);  // the digits given
}

TEST(GltfMaterial, SpecularDoesNotTouchMetal) {
  const Read m = read({{"extensions", {{"KHR_materials_specular", {{"specularFactor", 0.0}}}}}});
  const LobeUse lobe = baseLobe(m.material, white());
  EXPECT_NEAR(lobe.f0, 1.0, kRounding);
  EXPECT_NEAR(lobe.f90, 1.0, kRounding);
}

TEST(GltfMaterial, SpecularGlossiness) {
  const Read m = read({{"pbrMetallicRoughness", {{"roughnessFactor", 0.1}}},
                       {"extensions",
                        {{"KHR_materials_pbrSpecularGlossiness",
                          {{"specularFactor", {0.5, 0.5, 0.5}},
                           {"glossinessFactor", 0.8},
                           {"specularGlossinessTexture", {{"index", 3}}}}}}}});
  SlotTexels texels = white();
  EXPECT_NEAR(baseLobe(m.material, texels).alphaY, 0.04, kRounding);  // (1 - 0.8)^2
  EXPECT_NEAR(baseLobe(m.material, texels).f0, 0.5, kRounding);
  texels[kSpecularGlossiness] = {188, 188, 188, 0};
  EXPECT_NEAR(baseLobe(m.material, texels).alphaX, 1.0, kRounding);
  EXPECT_NEAR(baseLobe(m.material, texels).f0, 0.251443, 1e-6);  // the digits given
  EXPECT_EQ(slotsOfBase(m.material), std::vector<TextureSlot>{kSpecularGlossiness});
}

TEST(GltfMaterial, Coat) {
  const Read m = read({{"extensions",
                        {{"KHR_materials_clearcoat",
                          {{"clearcoatFactor", 0.5},
                           {"clearcoatRoughnessFactor", 0.6},
                           {"clearcoatTexture", {{"index", 0}}},
                           {"clearcoatRoughnessTexture", {{"index", 1}}}}}}}});
  SlotTexels texels = white();
  texels[kClearcoat] = {51, 255, 255, 255};
  texels[kClearcoatRoughness] = {255, 51, 255, 255};
  EXPECT_NEAR(clearcoatAt(m.material, texels), 0.1, kRounding);
  const LobeUse lobe = coatLobe(m.material, texels);
  EXPECT_NEAR(lobe.alphaX, 0.0144, kRounding);  // (0.6 * 0.2)^2
  EXPECT_EQ(lobe.alphaX, lobe.alphaY);
  EXPECT_EQ(lobe.f0, 0.04);
  EXPECT_EQ(lobe.f90, 1.0);
  EXPECT_EQ(slotsOfCoat(m.material), (std::vector<TextureSlot>{kClearcoat, kClearcoatRoughness}));
}

TEST(GltfMaterial, TexturesOfNoInfluenceAreNotNeeded) {
  const GltfJson textures{{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}};
  GltfJson pbr = textures;
  EXPECT_EQ(slotsOfBase(read({{"pbrMetallicRoughness", pbr}}).material),
            (std::vector<TextureSlot>{kMetallicRoughness, kBaseColor}));
  pbr["metallicFactor"] = 0.0;
  EXPECT_EQ(slotsOfBase(read({{"pbrMetallicRoughness", pbr}}).material),
            std::vector<TextureSlot>{kMetallicRoughness});
  pbr["roughnessFactor"] = 0.0;
  EXPECT_TRUE(slotsOfBase(read({{"pbrMetallicRoughness", pbr}}).material).empty());
}

TEST(GltfMaterial, FactorsOutOfRangeAreClampedAndNoted) {
  const Read m = read({{"pbrMetallicRoughness", {{"roughnessFactor", 1.5}, {"metallicFactor", -1}}}});
  EXPECT_EQ(m.material.roughness, 1.0);
  EXPECT_EQ(m.material.metallic, 0.0);
  ASSERT_EQ(m.notes.size(), 2u);
  EXPECT_NE(m.notes[0].find("roughnessFactor is 1.5"), std::string::npos) << m.notes[0];
}

TEST(GltfMaterial, WhatGgxDoesNotHoldIsNoted) {
  const Read m = read({{"extensions", {{"KHR_materials_sheen", {{"sheenRoughnessFactor", 0.5}}}}}});
  ASSERT_EQ(m.notes.size(), 1u);
  EXPECT_NE(m.notes[0].find("KHR_materials_sheen"), std::string::npos);
}

TEST(GltfMaterial, WrongTypesAreNamed) {
  const auto refused = [](const GltfJson& extension, const std::string& word) {
    try {
      read({{"extensions", extension}});
      ADD_FAILURE() << "accepted " << extension;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  refused({{"KHR_materials_ior", {{"ior", "1.5"}}}}, "ior is not a number");
  refused({{"KHR_materials_specular", {{"specularColorFactor", {1, 2}}}}}, "specularColorFactor");
  refused({{"KHR_materials_anisotropy", {{"anisotropyTexture", {{"texCoord", 1}}}}}}, "no index");
  refused({{"KHR_materials_clearcoat", {{"clearcoatTexture", {{"index", -3}}}}}}, "index -3");
}

TEST(TextureUse, Transform) {
  TextureUse use;
  use.offset = {0.0, 1.0};
  use.rotation = 1.5707963267948966;
  use.scale = {0.5, 0.5};
  // the lower left quarter, turned clockwise: an example of the extension
  const auto corner = use.transformed({1.0, 1.0});
  EXPECT_NEAR(corner[0], 0.5, kRounding);
  EXPECT_NEAR(corner[1], 0.5, kRounding);
  const auto right = use.transformed({1.0, 0.0});
  EXPECT_NEAR(right[0], 0.0, kRounding);
  EXPECT_NEAR(right[1], 0.5, kRounding);
}

}  // namespace
}  // namespace ltcfit
