// Whole scenes: what is counted, by which weight, and what is said about it.
#include "scene/gltf_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "export/atomic_file.h"
#include "scene/read_scene.h"
#include "tests/scene/gltf_builder.h"

namespace ltcfit {
namespace {

using test::GltfBuilder;
using test::GltfJson;
using test::imageOf;

using Rgba = std::array<std::uint8_t, 4>;

// float areas
constexpr double kRounding = 1e-6;

SceneUse read(const GltfBuilder& builder) {
  return sceneFromGltf(builder.glb(), {});
}

std::string all(const std::vector<std::string>& sentences) {
  std::string out;
  for (const std::string& s : sentences) out.append(s).append("\n");
  return out;
}

bool says(const std::vector<std::string>& sentences, const std::string& words) {
  return all(sentences).find(words) != std::string::npos;
}

double sum(const std::vector<LobeUse>& lobes) {
  double total = 0.0;
  for (const LobeUse& lobe : lobes) total += lobe.weight;
  return total;
}

// The share of a material's lobes that has this smaller alpha.
double shareOf(const MaterialUse& material, double alphaY) {
  double share = 0.0;
  for (const LobeUse& lobe : material.lobes)
    if (std::abs(lobe.alphaY - alphaY) < 1e-9) share += lobe.weight;
  return share / material.area;
}

GltfJson rough(int texture, const GltfJson& more = GltfJson::object()) {
  GltfJson info{{"index", texture}};
  info.update(more);
  return {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"metallicRoughnessTexture", info}}}};
}

// Left half of roughness 1/5, right half 1.
TexelImage halves(std::size_t size = 16) {
  return imageOf(size, size, [=](std::size_t x, std::size_t) {
    return Rgba{0, static_cast<std::uint8_t>(x < size / 2 ? 51 : 255), 0, 255};
  });
}

const GltfJson kClamp{{"wrapS", 33071}, {"wrapT", 33071}};

TEST(GltfScene, AtlasCountsWhatIsShown) {
  GltfBuilder builder;
  const int texture = builder.texture(halves());
  builder.quad(builder.material(rough(texture)), {0.125f, 0.125f, 0.375f, 0.375f});
  const SceneUse use = read(builder);
  ASSERT_EQ(use.materials.size(), 1u);
  const MaterialUse& m = use.materials[0];
  EXPECT_TRUE(m.textured);
  EXPECT_EQ(m.texels, 36u);  // 4 x 4, and one around for the filter
  ASSERT_EQ(m.lobes.size(), 1u);
  EXPECT_NEAR(m.lobes[0].alphaX, 0.04, 1e-12);
  EXPECT_NEAR(sum(m.lobes), 1.0, kRounding);
}

TEST(GltfScene, WeightIsAreaNotTexels) {
  GltfBuilder builder;
  const int texture = builder.texture(halves(64), kClamp);
  const int material = builder.material(rough(texture));
  // a tenth of the image on a surface of 1, another on one of 9
  builder.quad(material, {0.1f, 0.1f, 0.2f, 0.2f});
  builder.quad(material, {0.7f, 0.7f, 0.8f, 0.8f});
  builder.json["nodes"][1]["scale"] = {3, 3, 3};
  const SceneUse use = read(builder);
  ASSERT_EQ(use.materials.size(), 1u);
  EXPECT_NEAR(shareOf(use.materials[0], 0.04), 0.1, kRounding);
  EXPECT_NEAR(shareOf(use.materials[0], 1.0), 0.9, kRounding);
}

TEST(GltfScene, TransformAndCoordinatesOfTheTexture) {
  const auto alpha = [](const GltfJson& info) {
    GltfBuilder builder;
    const int texture = builder.texture(halves());
    builder.quad(builder.material(rough(texture, info)), {0.125f, 0.25f, 0.375f, 0.5f});
    builder.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        builder.vec2({0.625f, 0.1f, 0.875f, 0.1f, 0.875f, 0.9f, 0.625f, 0.9f});
    const SceneUse use = read(builder);
    EXPECT_EQ(use.materials.at(0).lobes.size(), 1u);
    return use.materials[0].lobes.at(0).alphaX;
  };
  EXPECT_NEAR(alpha(GltfJson::object()), 0.04, kRounding);
  EXPECT_NEAR(alpha({{"texCoord", 1}}), 1.0, kRounding);
  const auto transform = [](const GltfJson& t) {
    return GltfJson{{"extensions", {{"KHR_texture_transform", t}}}};
  };
  EXPECT_NEAR(alpha(transform({{"offset", {0.5, 0.0}}})), 1.0, kRounding);
  EXPECT_NEAR(alpha(transform({{"texCoord", 1}})), 1.0, kRounding);
  EXPECT_NEAR(alpha(transform({{"scale", {1.5, 1.0}}, {"offset", {0.4, 0.0}}})), 1.0, kRounding);
  // to the right by a turn of -90 degrees: u = 1 - v
  EXPECT_NEAR(alpha(transform({{"rotation", -1.5707963267948966}, {"offset", {1.0625, 0.0}}})), 1.0,
              kRounding);
}

TEST(GltfScene, WithoutCoordinatesAllTexelsCount) {
  GltfBuilder builder;
  const int texture = builder.texture(halves());
  builder.quad(builder.material(rough(texture, {{"texCoord", 2}})), {0.1f, 0.1f, 0.2f, 0.2f});
  const SceneUse use = read(builder);
  EXPECT_EQ(use.materials.at(0).texels, 256u);
  EXPECT_NEAR(shareOf(use.materials[0], 1.0), 0.5, kRounding);
  EXPECT_TRUE(says(use.materials[0].reasons, "no TEXCOORD_2")) << all(use.materials[0].reasons);
}

TEST(GltfScene, TexturesOfUnlikeSizesAreJoined) {
  // smooth where anisotropic: only a joint count sees it
  GltfBuilder builder;
  const int rough = builder.texture(halves(16), kClamp);
  const int strength =
      builder.texture(imageOf(4, 2,
                              [](std::size_t x, std::size_t) {
                                return Rgba{255, 128, static_cast<std::uint8_t>(x < 2 ? 255 : 0), 255};
                              }),
                      kClamp);
  builder.quad(builder.material(
      {{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", rough}}}, {"metallicFactor", 0}}},
       {"extensions",
        {{"KHR_materials_anisotropy",
          {{"anisotropyStrength", 0.5}, {"anisotropyTexture", {{"index", strength}}}}}}}}));
  const SceneUse use = read(builder);
  const MaterialUse& m = use.materials.at(0);
  ASSERT_EQ(m.lobes.size(), 2u);
  EXPECT_NEAR(m.lobes[0].alphaY, 0.04, kRounding);
  EXPECT_NEAR(m.lobes[0].alphaX, 0.04 + 0.96 * 0.25, kRounding);
  EXPECT_NEAR(m.lobes[0].weight, 0.5, 0.01);  // the middle column is of both triangles
  EXPECT_NEAR(m.lobes[1].alphaX, 1.0, kRounding);
  EXPECT_NEAR(sum(m.lobes), 1.0, kRounding);
}

TEST(GltfScene, UnlikeCoordinatesAreIndependent) {
  GltfBuilder builder;
  const int rough = builder.texture(halves(16), kClamp);
  const int strength = builder.texture(halves(8), kClamp);
  builder.quad(builder.material(
      {{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", rough}}}, {"metallicFactor", 0}}},
       {"extensions",
        {{"KHR_materials_specular",
          {{"specularColorTexture",
            {{"index", strength},
             {"extensions", {{"KHR_texture_transform", {{"offset", {0.25, 0}}}}}}}}}}}}}));
  const SceneUse use = read(builder);
  const MaterialUse& m = use.materials.at(0);
  // two roughnesses times two reflectances
  EXPECT_EQ(m.lobes.size(), 2u);  // the reflectances differ by less than 1/16
  EXPECT_TRUE(says(m.reasons, "independent")) << all(m.reasons);
  EXPECT_NEAR(m.lobes[0].f0, m.lobes[1].f0, 1e-3);  // pairs of 256 texels
}

TEST(GltfScene, ImagesOfOtherKindsAreAssumed) {
  GltfBuilder builder;
  const int view = builder.view(std::string("\253KTX 20\273\r\n\x1a\n", 12) + std::string(100, '\0'));
  const int image = builder.push("images", {{"bufferView", view}, {"mimeType", "image/ktx2"}});
  const int texture =
      builder.push("textures", {{"extensions", {{"KHR_texture_basisu", {{"source", image}}}}}});
  builder.quad(builder.material({{"pbrMetallicRoughness",
                                  {{"metallicFactor", 0},
                                   {"roughnessFactor", 0.5},
                                   {"metallicRoughnessTexture", {{"index", texture}}}}}}));
  for (const bool fallback : {false, true}) {
    if (fallback) builder.json["textures"][0] = {{"source", image}};
    const SceneUse use = read(builder);
    const MaterialUse& m = use.materials.at(0);
    EXPECT_TRUE(says(m.reasons, "could not be read (KTX2)")) << all(m.reasons);
    EXPECT_EQ(m.texels, 0u);  // none was looked up
    EXPECT_EQ(m.lobes.front().alphaX, 0.0);
    EXPECT_NEAR(m.lobes.back().alphaX, 0.25, kRounding);
    // of half the roughness, half is below a quarter
    double below = 0.0;
    for (const LobeUse& lobe : m.lobes) below += lobe.alphaX < 0.0625 ? lobe.weight : 0.0;
    EXPECT_NEAR(below, 0.5, 0.01);
  }
}

TEST(GltfScene, AssumedImagesCountNoTexels) {
  // beside one that is read, of another mapping
  GltfBuilder builder;
  const int read16 = builder.texture(halves(16), kClamp);
  const int assumed = builder.push("textures", {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}});
  builder.quad(builder.material(
      {{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", read16}}}, {"metallicFactor", 0}}},
       {"extensions", {{"KHR_materials_specular", {{"specularTexture", {{"index", assumed}}}}}}}}));
  const MaterialUse m = read(builder).materials.at(0);
  EXPECT_TRUE(says(m.reasons, "could not be read (WebP)")) << all(m.reasons);
  EXPECT_EQ(m.texels, 256u);
  EXPECT_NEAR(sum(m.lobes), 1.0, kRounding);
}

TEST(GltfScene, CompressedGeometryCountsAlike) {
  for (const char* extension : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
    GltfBuilder builder;
    const int texture = builder.texture(halves());
    builder.quad(builder.material(rough(texture)), {0.1f, 0.1f, 0.2f, 0.2f});
    builder.quad(builder.material(GltfJson::object()));
    GltfJson& primitive = builder.json["meshes"][0]["primitives"][0];
    if (std::string(extension) == "KHR_draco_mesh_compression") {
      // as encoders write it: accessors without data
      for (const char* key : {"POSITION", "TEXCOORD_0"})
        builder.json["accessors"][primitive["attributes"][key].get<std::size_t>()].erase("bufferView");
      builder.json["accessors"][primitive["indices"].get<std::size_t>()].erase("bufferView");
      primitive["extensions"][extension] = {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
    } else {
      const std::size_t accessor = primitive["attributes"]["POSITION"].get<std::size_t>();
      const std::size_t view = builder.json["accessors"][accessor]["bufferView"].get<std::size_t>();
      builder.json["bufferViews"][view]["extensions"][extension] = {{"buffer", 0}, {"byteLength", 4}};
    }
    const SceneUse use = read(builder);
    ASSERT_EQ(use.materials.size(), 2u) << extension;
    EXPECT_EQ(use.materials[0].area, 0.5);
    EXPECT_EQ(use.materials[0].texels, 256u);
    EXPECT_TRUE(says(use.materials[0].reasons, "compressed")) << all(use.materials[0].reasons);
    EXPECT_TRUE(says(use.notes, "compressed geometry): all materials count alike")) << all(use.notes);
  }
}

TEST(GltfScene, NoAreaCountsAlike) {
  GltfBuilder builder;
  builder.quad(builder.material(GltfJson::object()));
  builder.quad(builder.material(rough(builder.texture(halves(), kClamp))), {0.1f, 0.1f, 0.2f, 0.2f});
  for (GltfJson& node : builder.json["nodes"]) node["scale"] = {0, 0, 0};
  const SceneUse use = read(builder);
  ASSERT_EQ(use.materials.size(), 2u);
  EXPECT_EQ(use.materials[0].area, 0.5);
  EXPECT_TRUE(says(use.notes, "The surfaces have no area: all materials count alike.")) << all(use.notes);
  EXPECT_EQ(use.materials[1].lobes.size(), 1u);  // coverage is known all the same
}

TEST(GltfScene, PrimitivesWithoutMaterialHaveTheDefault) {
  GltfBuilder builder;
  builder.quad(0);
  builder.json["meshes"][0]["primitives"][0].erase("material");
  const SceneUse use = read(builder);
  ASSERT_EQ(use.materials.size(), 1u);
  EXPECT_EQ(use.materials[0].name, "default material");
  EXPECT_NEAR(use.materials[0].lobes.at(0).f0, 1.0, kRounding);
}

TEST(GltfScene, UnlitUnusedAndUnnamed) {
  GltfBuilder builder;
  builder.quad(builder.material({{"name", "sky"},
                                 {"extensions", {{"KHR_materials_unlit", GltfJson::object()}}},
                                 {"emissiveFactor", {1, 1, 1}}}));
  builder.quad(builder.material(GltfJson::object()));
  builder.material({{"name", "spare"}});
  const SceneUse use = read(builder);
  ASSERT_EQ(use.materials.size(), 1u);
  EXPECT_EQ(use.materials[0].name, "material 1");
  EXPECT_EQ(use.materials[0].area, 1.0);
  EXPECT_TRUE(says(use.notes, "'sky' is unlit")) << all(use.notes);
  EXPECT_TRUE(says(use.notes, "Not shown and not counted: spare.")) << all(use.notes);
  EXPECT_FALSE(use.lights.any());
}

TEST(GltfScene, NothingShown) {
  const SceneUse use = read(GltfBuilder());
  EXPECT_TRUE(use.materials.empty());
  EXPECT_TRUE(says(use.notes, "Nothing that the scene shows")) << all(use.notes);
  EXPECT_FALSE(use.lights.any());
  EXPECT_TRUE(says(use.lights.reasons, "--lights"));
}

TEST(GltfScene, LightsThatHaveNoExtent) {
  GltfBuilder builder;
  builder.quad(builder.material(GltfJson::object()));
  builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
  builder.json["extensionsRequired"] = {"XYZ_other"};
  const SceneUse use = read(builder);
  EXPECT_TRUE(says(use.notes, "KHR_lights_punctual have no extent"));
  EXPECT_TRUE(says(use.notes, "requires XYZ_other"));
}

TEST(GltfScene, EmissionMayBeSwitchedOff) {
  const auto emits = [](double strength, const GltfJson& factor) {
    GltfBuilder builder;
    builder.quad(builder.material(
        {{"emissiveFactor", factor},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", strength}}}}}}));
    return read(builder).lights.any();
  };
  EXPECT_TRUE(emits(1.0, {0.0, 0.1, 0.0}));
  EXPECT_FALSE(emits(0.0, {1.0, 1.0, 1.0}));
  EXPECT_FALSE(emits(5.0, {0.0, 0.0, 0.0}));
}

const std::string kScenes = std::string(LTCFIT_DATA_DIR) + "/scenes/";

TEST(GltfFixtures, Lamp) {
  const SceneUse use = readScene(kScenes + "lamp.glb");
  EXPECT_EQ(use.name, "lamp.glb");
  ASSERT_EQ(use.materials.size(), 4u);
  const MaterialUse& metal = use.materials[0];
  EXPECT_EQ(metal.name, "Lamp Metal");
  // quads of sides 1, 1/4 and 1/2
  EXPECT_NEAR(metal.area, 16.0 / 21.0, kRounding);
  EXPECT_EQ(metal.texels, 196u);       // 14 x 14 of 16 x 16
  EXPECT_EQ(metal.lobes.size(), 28u);  // 14 roughnesses by 2 strengths
  EXPECT_NEAR(metal.lobes.front().alphaY, std::pow(56.0 / 255.0, 2.0), kRounding);
  EXPECT_NEAR(metal.lobes.back().alphaY, std::pow(121.0 / 255.0, 2.0), kRounding);
  EXPECT_NEAR(metal.lobes.back().alphaX, 1.0, kRounding);
  EXPECT_EQ(use.materials[1].name, "Lamp Metal, clearcoat");
  EXPECT_NEAR(use.materials[1].lobes.at(0).alphaX, 0.0225, kRounding);
  EXPECT_EQ(use.materials[1].area, metal.area);
  EXPECT_TRUE(use.lights.polygon);
  EXPECT_TRUE(use.lights.oneSided);
  EXPECT_FALSE(use.lights.textured || use.lights.twoSided || use.lights.disk || use.lights.sphere);
  EXPECT_TRUE(says(use.notes, "KHR_materials_transmission"));
}

TEST(GltfFixtures, ExternalImagesOfTwoKinds) {
  const SceneUse use = readScene(kScenes + "metal_rough.gltf");
  ASSERT_EQ(use.materials.size(), 1u);
  const MaterialUse& steel = use.materials[0];
  EXPECT_EQ(steel.texels, 128u);
  ASSERT_EQ(steel.lobes.size(), 16u);
  // rows of roughness 64/255 to 184/255; grey 160 above, 200 below, by the JPEG
  EXPECT_NEAR(steel.lobes.front().alphaX, std::pow(64.0 / 255.0, 2.0), kRounding);
  EXPECT_NEAR(steel.lobes.back().alphaX, std::pow(184.0 / 255.0, 2.0), kRounding);
  EXPECT_NEAR(steel.lobes.front().f0, 0.351533, 1e-5);  // sRGB 160, the digits given
  EXPECT_NEAR(steel.lobes.back().f0, 0.577580, 1e-5);   // sRGB 200
}

TEST(GltfFixtures, ClearcoatOfATexture) {
  const SceneUse use = readScene(kScenes + "clearcoat.gltf");
  ASSERT_EQ(use.materials.size(), 4u);
  EXPECT_NEAR(use.materials[0].lobes.at(0).f0, 0.04 * 0.7 + 0.3 * 0.2126 * 0.7, kRounding);
  const MaterialUse& coat = use.materials[3];
  EXPECT_EQ(coat.name, "half varnished, clearcoat");
  EXPECT_EQ(coat.texels, 16u);
  EXPECT_NEAR(coat.area, 0.25, kRounding);  // half of a half
  EXPECT_NEAR(sum(coat.lobes), coat.area, kRounding);
  EXPECT_EQ(coat.lobes.size(), 4u);
}

TEST(GltfFixtures, StrengthsDiscsPlainEmissive) {
  EXPECT_EQ(readScene(kScenes + "strengths.gltf").materials.size(), 49u);
  const SceneUse discs = readScene(kScenes + "discs.gltf");
  ASSERT_EQ(discs.materials.size(), 11u);
  EXPECT_NEAR(discs.materials[5].lobes.at(0).alphaY, 0.25, kRounding);
  EXPECT_EQ(discs.materials[5].lobes.at(0).alphaX, 1.0);
  const SceneUse plain = readScene(kScenes + "plain.gltf");
  ASSERT_EQ(plain.materials.size(), 1u);
  EXPECT_FALSE(plain.materials[0].textured);
  EXPECT_EQ(plain.materials[0].texels, 0u);
  const LightUse lights = readScene(kScenes + "emissive.gltf").lights;
  EXPECT_TRUE(lights.polygon && lights.textured && lights.oneSided && lights.twoSided);
  EXPECT_EQ(lights.reasons.size(), 2u);
}

TEST(ReadScene, NamesTheFile) {
  for (const char* file : {"nowhere.gltf", "discs.png", "README.md"}) {
    try {
      readScene(kScenes + file);
      ADD_FAILURE() << file;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace ltcfit
