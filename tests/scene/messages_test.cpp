// What is said of scenes that are wrong.
#include <gtest/gtest.h>

#include <string>

#include "export/atomic_file.h"
#include "scene/gltf_scene.h"
#include "scene/json_scene.h"
#include "scene/read_scene.h"
#include "tests/scene/gltf_builder.h"

namespace ltcfit {
namespace {

using test::GltfBuilder;
using test::GltfJson;

const std::string kScenes = std::string(LTCFIT_DATA_DIR) + "/scenes/";

template <typename Read>
std::string messageOf(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string messageOfMaterial(const GltfJson& material) {
  GltfBuilder builder;
  builder.quad(builder.material(material));
  return messageOf([&] { sceneFromGltf(builder.glb(), {}); });
}

TEST(SceneMessages, MaterialFieldsOfWrongTypes) {
  const auto core = [](const char* key, const GltfJson& value) {
    return messageOfMaterial({{"name", "tin"}, {"pbrMetallicRoughness", {{key, value}}}});
  };
  EXPECT_EQ(core("roughnessFactor", 0.3), "accepted");
  EXPECT_EQ(core("roughnessFactor", "0.3"), "Material 'tin': roughnessFactor is not a number");
  EXPECT_EQ(core("metallicFactor", nullptr), "Material 'tin': metallicFactor is not a number");
  EXPECT_EQ(core("baseColorFactor", {1, 1, "1", 1}), "Material 'tin': baseColorFactor is not a colour");
  EXPECT_EQ(core("baseColorFactor", 1), "Material 'tin': baseColorFactor is not a colour");
  EXPECT_EQ(core("baseColorTexture", 0), "Material 'tin': baseColorTexture is not an object");
  EXPECT_EQ(core("metallicRoughnessTexture", {{"index", "0"}}),
            "Material 'tin': index of metallicRoughnessTexture is not an integer");
  EXPECT_EQ(core("baseColorTexture", {{"index", 0}, {"texCoord", "1"}}),
            "Material 'tin': texCoord of baseColorTexture is not an integer");
  EXPECT_EQ(messageOfMaterial({{"pbrMetallicRoughness", 1}}),
            "Material 0: pbrMetallicRoughness is not an object");
  EXPECT_EQ(messageOfMaterial({{"emissiveFactor", "white"}}), "Material 0: emissiveFactor is not a colour");
  EXPECT_EQ(messageOfMaterial({{"doubleSided", 1}}), "Material 0: doubleSided is not true or false");
  EXPECT_EQ(messageOfMaterial(3), "material 0 is not an object");
}

TEST(SceneMessages, ExtensionFieldsOfWrongTypes) {
  const auto extension = [](const std::string& name, const char* key, const GltfJson& value) {
    return messageOfMaterial({{"name", "tin"}, {"extensions", {{name, {{key, value}}}}}});
  };
  const auto number = [&](const std::string& name, const char* key) {
    EXPECT_EQ(extension(name, key, 0.5), "accepted");
    EXPECT_EQ(extension(name, key, "0.5"), std::string("Material 'tin': ") + key + " is not a number");
  };
  number("KHR_materials_anisotropy", "anisotropyStrength");
  number("KHR_materials_ior", "ior");
  number("KHR_materials_specular", "specularFactor");
  number("KHR_materials_clearcoat", "clearcoatFactor");
  number("KHR_materials_clearcoat", "clearcoatRoughnessFactor");
  number("KHR_materials_pbrSpecularGlossiness", "glossinessFactor");
  number("KHR_materials_emissive_strength", "emissiveStrength");
  EXPECT_EQ(extension("KHR_materials_specular", "specularColorFactor", {1, "1", 1}),
            "Material 'tin': specularColorFactor is not a colour");
  EXPECT_EQ(extension("KHR_materials_pbrSpecularGlossiness", "specularFactor", 1),
            "Material 'tin': specularFactor is not a colour");
  EXPECT_EQ(extension("KHR_materials_clearcoat", "clearcoatTexture", {{"index", 0}, {"texCoord", "1"}}),
            "Material 'tin': texCoord of clearcoatTexture is not an integer");
  EXPECT_EQ(messageOfMaterial({{"extensions", {{"KHR_materials_ior", 1.4}}}}),
            "Material 0: KHR_materials_ior is not an object");
  EXPECT_EQ(messageOfMaterial({{"extensions", 1}}), "Material 0: extensions is not an object");
  const GltfJson turned{{"KHR_texture_transform", {{"rotation", "1"}}}};
  EXPECT_EQ(messageOfMaterial({{"pbrMetallicRoughness",
                                {{"metallicRoughnessTexture", {{"index", 0}, {"extensions", turned}}}}}}),
            "Material 'material 0': KHR_texture_transform: rotation is not a number");
}

TEST(SceneMessages, FilesOfOtherKinds) {
  const std::string neither = "neither glTF nor a scene description";
  EXPECT_EQ(messageOf([] { readScene(kScenes + "discs.png"); }),
            kScenes + "discs.png: a picture (PNG), " + neither);
  EXPECT_EQ(messageOf([] { readScene(kScenes + "metal_rough.jpg"); }),
            kScenes + "metal_rough.jpg: a picture (JPEG), " + neither);
  EXPECT_EQ(messageOf([] { readScene(kScenes + "README.md"); }), kScenes + "README.md: " + neither);
  for (const char* text : {"", " \n", "[]", "\xef\xbb\xbf"})
    EXPECT_EQ(messageOf([&] { sceneFromGltf(text, {}); }), neither) << text;
  const std::string marked = "\xef\xbb\xbf{\"asset\":{\"version\":\"2.0\"}}";
  EXPECT_EQ(messageOf([&] { sceneFromGltf(marked, {}); }), "accepted");
}

TEST(SceneMessages, NumbersThatJsonHasNot) {
  const auto gltf = [](const std::string& number) {
    return messageOf([&] {
      sceneFromGltf(R"({"asset":{"version":"2.0"},"materials":[{"alphaCutoff":)" + number + "}]}", {});
    });
  };
  const auto description = [](const std::string& number) {
    return messageOf([&] {
      sceneFromJson(
          R"({"format":"ltc-scene","version":1,"materials":[{"name":"a","roughness":)" + number + "}]}", {});
    });
  };
  EXPECT_EQ(gltf("0.5"), "accepted");
  EXPECT_EQ(description("0.5"), "accepted");
  for (const char* word : {"NaN", "nan", "Infinity", "inf"})
    for (const char* sign : {"", "-"})
      for (const std::string& message :
           {gltf(std::string(sign) + word), description(std::string(sign) + word)})
        EXPECT_TRUE(message.starts_with(std::string(word) + " at byte") &&
                    message.ends_with("JSON knows neither NaN nor Infinity"))
            << message;
  for (const char* number : {"1e999", "-1e999"}) {
    EXPECT_EQ(gltf(number), "a number is out of range, beyond 1.8e308");
    EXPECT_EQ(description(number), "a number is out of range, beyond 1.8e308");
  }
  EXPECT_TRUE(gltf("nun").starts_with("no valid JSON at byte"));
  EXPECT_TRUE(description("nun").starts_with("no valid JSON at byte"));
}

}  // namespace
}  // namespace ltcfit
