// Scenes described by hand.
#include "scene/json_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <string>

#include "export/atomic_file.h"
#include "scene/read_scene.h"

namespace ltcfit {
namespace {

using Json = nlohmann::json;

const std::string kScenes = std::string(LTCFIT_DATA_DIR) + "/scenes/";

Json scene(const Json& material) {
  return {{"format", "ltc-scene"}, {"version", 1}, {"materials", {material}}};
}

SceneUse read(const Json& json) {
  return sceneFromJson(json.dump(), kScenes);
}

std::vector<LobeUse> lobesOf(const Json& material) {
  Json named = material;
  named["name"] = "m";
  return read(scene(named)).materials.at(0).lobes;
}

void refused(const Json& json, const std::string& word) {
  try {
    read(json);
    ADD_FAILURE() << "accepted: " << json;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

// products of a few rounded numbers
constexpr double kRounding = 1e-12;

TEST(JsonScene, OneNumber) {
  const std::vector<LobeUse> lobes = lobesOf({{"roughness", 0.4}});
  ASSERT_EQ(lobes.size(), 1u);
  EXPECT_NEAR(lobes[0].alphaX, 0.16, kRounding);
  EXPECT_EQ(lobes[0].alphaX, lobes[0].alphaY);
  EXPECT_NEAR(lobes[0].f0, 0.04, kRounding);
  EXPECT_EQ(lobes[0].f90, 1.0);
  EXPECT_EQ(lobes[0].weight, 1.0);
}

TEST(JsonScene, AnisotropyIsThatOfGltf) {
  const std::vector<LobeUse> lobes =
      lobesOf({{"roughness", 0.5}, {"anisotropy", 0.6}, {"f0", 0.5}, {"f90", 0.75}});
  ASSERT_EQ(lobes.size(), 1u);
  EXPECT_NEAR(lobes[0].alphaX, 0.25 * 0.64 + 0.36, kRounding);
  EXPECT_NEAR(lobes[0].alphaY, 0.25, kRounding);
  EXPECT_NEAR(lobes[0].f0, 0.5, kRounding);
  EXPECT_NEAR(lobes[0].f90, 0.75, kRounding);
}

TEST(JsonScene, AlphasInEitherOrder) {
  for (const bool swapped : {false, true}) {
    const std::vector<LobeUse> lobes =
        lobesOf({{"alpha_x", swapped ? 0.1 : 0.3}, {"alpha_y", swapped ? 0.3 : 0.1}});
    ASSERT_EQ(lobes.size(), 1u);
    EXPECT_NEAR(lobes[0].alphaX, 0.3, kRounding);
    EXPECT_NEAR(lobes[0].alphaY, 0.1, kRounding);
  }
}

TEST(JsonScene, RangeIsEvenInRoughness) {
  const std::vector<LobeUse> lobes = lobesOf({{"roughness", {0.0, 1.0}}});
  ASSERT_EQ(lobes.size(), 65u);
  EXPECT_EQ(lobes.front().alphaX, 0.0);
  EXPECT_EQ(lobes.back().alphaX, 1.0);
  EXPECT_NEAR(lobes[32].alphaX, 0.25, kRounding);
  for (const LobeUse& lobe : lobes) EXPECT_NEAR(lobe.weight, 1.0 / 65.0, kRounding);
  const std::vector<LobeUse> alphas = lobesOf({{"alpha_x", {0.0, 1.0}}, {"alpha_y", 0.0}});
  ASSERT_EQ(alphas.size(), 65u);
  EXPECT_NEAR(alphas[32].alphaX, 0.25, kRounding);
}

TEST(JsonScene, ValuesWithWeights) {
  const std::vector<LobeUse> lobes =
      lobesOf({{"roughness", {{"values", {0.2, 0.6, 0.9}}, {"weights", {3, 1, 0}}}}});
  ASSERT_EQ(lobes.size(), 2u);
  EXPECT_NEAR(lobes[0].weight, 0.75, kRounding);
  EXPECT_NEAR(lobes[1].alphaX, 0.36, kRounding);
}

TEST(JsonScene, Image) {
  const SceneUse use = read(scene(
      {{"name", "m"}, {"roughness", {{"image", "metal_rough.png"}, {"channel", "g"}, {"scale", 0.5}}}}));
  const MaterialUse& m = use.materials.at(0);
  EXPECT_TRUE(m.textured);
  EXPECT_EQ(m.texels, 256u);
  ASSERT_EQ(m.lobes.size(), 17u);
  EXPECT_EQ(m.lobes[0].alphaX, 0.0);
  EXPECT_NEAR(m.lobes[0].weight, 0.5, kRounding);
  EXPECT_NEAR(m.lobes[1].alphaX, std::pow(32.0 / 255.0, 2.0), kRounding);
}

TEST(JsonScene, ManyCombinationsStayFew) {
  const std::vector<LobeUse> lobes =
      lobesOf({{"roughness", {0.0, 1.0}}, {"anisotropy", {0.0, 1.0}}, {"f0", {0.0, 1.0}}});
  EXPECT_LE(lobes.size(), 4096u);
  EXPECT_GT(lobes.size(), 512u);
  double sum = 0.0;
  for (const LobeUse& lobe : lobes) sum += lobe.weight;
  EXPECT_NEAR(sum, 1.0, 1e-9);  // 274625 additions
}

TEST(JsonScene, AreasLightsViews) {
  const SceneUse use = readScene(kScenes + "lobby.json");
  EXPECT_EQ(use.name, "lobby");
  ASSERT_EQ(use.materials.size(), 5u);
  EXPECT_NEAR(use.materials[0].area, 40.0 / 76.0, kRounding);
  EXPECT_TRUE(use.lights.polygon && use.lights.disk && use.lights.oneSided);
  EXPECT_FALSE(use.lights.sphere || use.lights.textured || use.lights.twoSided);
  EXPECT_EQ(use.views.low, 0.0);
  EXPECT_NEAR(use.views.high, 85.0 / 180.0 * std::numbers::pi, kRounding);
  EXPECT_TRUE(use.notes.empty());
}

TEST(JsonScene, WhatIsLeftOut) {
  const SceneUse use =
      read({{"format", "ltc-scene"},
            {"version", 1},
            {"materials", {{{"name", "a"}, {"roughness", 0}}, {{"name", "b"}, {"roughness", 1}}}}});
  EXPECT_EQ(use.materials.at(1).area, 0.5);
  EXPECT_FALSE(use.lights.any());
  EXPECT_NE(use.lights.reasons.at(0).find("--lights"), std::string::npos);
  EXPECT_EQ(use.views.high, ViewUse().high);
  ASSERT_EQ(use.notes.size(), 1u);
  Json lit = scene({{"name", "a"}, {"roughness", 0}});
  lit["lights"] = {"sphere"};
  EXPECT_TRUE(read(lit).lights.oneSided);
  lit["light_sides"] = {"two"};
  EXPECT_FALSE(read(lit).lights.oneSided);
}

TEST(JsonScene, MistakesAreNamed) {
  const Json good{{"name", "m"}, {"roughness", 0.5}};
  const auto with = [&](const char* key, const Json& value) {
    Json material = good;
    material[key] = value;
    return scene(material);
  };
  read(scene(good));
  refused(with("rougness", 0.5), "unknown field 'rougness'; there is name, roughness, anisotropy");
  refused(with("roughness", 1.5), "materials[0].roughness is 1.5, not within 0 to 1");
  refused(with("roughness", "0.5"), "neither a number");
  refused(with("roughness", {0.7, 0.3}), "roughness[1] is 0.3, not within 0.7 to 1");
  refused(with("roughness", {0.1, 0.2, 0.3}), "not a range");
  refused(with("roughness", {{"values", Json::array()}}), "values is empty");
  refused(with("roughness", {{"values", {0.1, "x"}}}), "values[1] is not a number");
  refused(with("roughness", {{"values", {0.1}}, {"weights", {1, 2}}}), "1 values and 2 weights");
  refused(with("roughness", {{"values", {0.1}}, {"weights", {0}}}), "all 0");
  refused(with("roughness", {{"values", {0.1}}, {"weights", {-1}}}), "weights[0] is -1");
  refused(with("roughness", {{"values", {0.1}}, {"weight", {1}}}), "unknown field 'weight'");
  refused(with("roughness", {{"image", "gone.png"}}), "gone.png");
  refused(with("roughness", {{"image", "discs.png"}, {"channel", "x"}}), "there is r, g, b, a");
  refused(with("roughness", {{"image", "discs.png"}, {"channel", ""}}), "channel is ''");
  refused(with("roughness", {{"image", "plain.gltf"}}), "neither a PNG nor a JPEG");
  refused(with("alpha_x", 0.5), "both roughness or anisotropy and alpha_x");
  refused(scene({{"name", "m"}, {"alpha_x", 0.5}}), "needs both");
  refused(scene({{"name", "m"}}), "roughness is missing");
  refused(scene({{"roughness", 0.5}}), "name is missing");
  refused(with("area", 0), "area is 0");
  refused(with("f0", 2), "f0 is 2");
  refused(scene(3), "materials[0] is not an object");
  Json many = with("f0", {{"values", std::vector<double>(5000, 0.5)}});
  many["materials"][0]["f90"] = many["materials"][0]["f0"];
  refused(many, "more than 4194304 combinations");

  const auto file = [&](const char* key, const Json& value) {
    Json json = scene(good);
    json[key] = value;
    return json;
  };
  refused(file("format", "scene"), "format");
  refused(file("version", 2), "version is not 1");
  refused(file("materials", Json::array()), "materials is empty");
  refused(file("lights", {"tube"}), "lights has 'tube'; there is polygon, disk, sphere, textured");
  refused(file("light_sides", {"both"}), "there is one, two");
  refused(file("views", {0, 100}), "views[1] is 100");
  refused(file("views", {50, 10}), "views[1] is 10");
  refused(file("views", 50), "views is not an array");
  refused(file("camera", 1), "unknown field 'camera'");
  refused(file("materials", {good, {{"name", "b"}, {"roughness", 1}, {"area", 2}}}), "all or none");
}

TEST(JsonScene, SchemaMayBeNamed) {
  Json json{{"$schema", "ltc-scene.schema.json"},
            {"format", "ltc-scene"},
            {"version", 1},
            {"materials", {{{"name", "a"}, {"roughness", 0.5}}}}};
  EXPECT_EQ(read(json).materials.size(), 1u);
  json["$schema"] = 1;
  refused(json, "$schema is not a string");
}

TEST(JsonScene, SchemaKnowsTheSameFields) {
  const Json schema = Json::parse(readFile(kScenes + "ltc-scene.schema.json"));
  const auto keys = [](const Json& object) {
    std::set<std::string> out;
    for (const auto& [key, value] : object.items()) out.insert(key);
    return out;
  };
  EXPECT_EQ(keys(schema["properties"]),
            (std::set<std::string>{"$schema", "format", "version", "name", "materials", "lights",
                                   "light_sides", "views"}));
  EXPECT_EQ(
      keys(schema["$defs"]["material"]["properties"]),
      (std::set<std::string>{"name", "roughness", "anisotropy", "alpha_x", "alpha_y", "f0", "f90", "area"}));
  EXPECT_EQ(schema["properties"]["lights"]["items"]["enum"], Json({"polygon", "disk", "sphere", "textured"}));
}

TEST(JsonScene, IsRecognized) {
  EXPECT_TRUE(isSceneDescription(" \n{\"format\": \"ltc-scene\"}"));
  EXPECT_FALSE(isSceneDescription("{\"asset\": {}}"));
  EXPECT_FALSE(isSceneDescription("glTF \"ltc-scene\""));
  EXPECT_FALSE(isSceneDescription(""));
}

}  // namespace
}  // namespace ltcfit
