// A small file that would take gigabytes is refused before it does, with the number of bytes.
#include <gtest/gtest.h>

#include <string>

#include "export/atomic_file.h"
#include "scene/gltf_scene.h"
#include "scene/json_scene.h"
#include "tests/scene/gltf_builder.h"

namespace ltcfit {
namespace {

using test::GltfBuilder;
using test::GltfJson;

template <typename Read>
std::string messageOf(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// A file that repeats `part`, with commas, between `start` and `end`.
std::string messageOfRepeated(const std::string& start, const std::string& part, std::size_t count,
                              const std::string& end) {
  std::string text = R"({"asset":{"version":"2.0"},)" + start + part;
  text.reserve(text.size() + count * (part.size() + 1) + end.size());
  for (std::size_t i = 1; i < count; ++i) text.append(",").append(part);
  text += end + "}";
  return messageOf([&] { sceneFromGltf(text, {}); });
}

TEST(SceneMemory, ObjectsOfThreeBytes) {
  const auto refused = [](const std::string& key) {
    return "its JSON would take more than 4294967296 bytes of memory, which is the limit: too many objects "
           "('" +
           key + "' came last)";
  };
  EXPECT_EQ(messageOfRepeated("\"materials\":[", "{}", 4 << 20, "]"), refused("materials"));
  EXPECT_EQ(messageOfRepeated("\"nodes\":[", "{}", 8 << 20, "]"), refused("nodes"));
  EXPECT_EQ(messageOfRepeated("\"meshes\":[{\"primitives\":[", "{}", 10 << 20, "]}]"), refused("meshes"));
  EXPECT_EQ(messageOfRepeated("\"nodes\":[{\"extras\":[", "[]", 20 << 20, "]}]"), refused("nodes"));
  // as many as large scenes have
  EXPECT_EQ(messageOfRepeated("\"nodes\":[", "{}", 1 << 16, "]"), "accepted");
  EXPECT_EQ(messageOfRepeated("\"nodes\":[{\"extras\":[", "[]", 1 << 16, "]}]"), "accepted");
}

TEST(SceneMemory, TrianglesOfSharedAccessors) {
  const auto file = [](std::size_t primitives) {
    GltfBuilder builder;
    const GltfJson one{{"attributes", {{"POSITION", builder.vec3({0, 0, 0, 1, 0, 0, 1, 1, 0})}}},
                       {"indices", builder.indices(std::vector<std::uint16_t>(30000, 0))}};
    builder.push("meshes", {{"primitives", GltfJson(primitives, one)}});
    builder.node({{"mesh", 0}});
    return messageOf([&] { sceneFromGltf(builder.glb(), {}); });
  };
  EXPECT_EQ(file(10), "accepted");
  // 20 bytes each
  EXPECT_EQ(
      file(11000),
      "mesh 0, primitive 10737: 107380000 triangles so far would take 2147600000 bytes of memory; up to "
      "2147483648 are allowed: read parts of the scene one by one");
}

TEST(SceneMemory, CountsThatNoDataBounds) {
  const auto file = [](const GltfJson& accessor) {
    GltfBuilder builder;
    builder.view(std::string(64, '\0'));
    builder.mesh({{"attributes", {{"POSITION", builder.push("accessors", accessor)}}}});
    builder.node({{"mesh", 0}});
    return messageOf([&] { sceneFromGltf(builder.glb(), {}); });
  };
  GltfJson accessor{{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}};
  const auto with = [&](int count, int sparse) {
    accessor["count"] = count;
    accessor["sparse"] = {{"count", sparse},
                          {"indices", {{"bufferView", 0}, {"componentType", 5121}}},
                          {"values", {{"bufferView", 0}}}};
    return file(accessor);
  };
  EXPECT_EQ(with(3, 1), "accepted");
  const std::string start = "mesh 0, primitive 0: accessor 0: ";
  EXPECT_EQ(with(1 << 23, 1), start + "8388608 elements without data; up to 4194304 are read");
  EXPECT_EQ(with(3, 4), start + "sparse: 4 of 3 elements");
  EXPECT_EQ(with(1 << 20, 1 << 20).substr(0, start.size() + 15), start + "sparse.indices:");
  EXPECT_EQ(with(1 << 20, 6).substr(0, start.size() + 14), start + "sparse.values:");
}

TEST(SceneMemory, LobesOfManyMaterials) {
  MaterialUse material;
  material.name = "tin";
  material.lobes.resize(100);
  SceneUse use;
  const std::size_t limit = 1000 * sizeof(LobeUse);
  for (int i = 0; i < 10; ++i) addMaterial(use, material, limit);
  EXPECT_EQ(use.materials.size(), 10u);
  EXPECT_EQ(
      messageOf([&] { addMaterial(use, material, limit); }),
      "material 'tin': with it, the lobes of 11 materials would take 44000 bytes of memory; up to 40000 are "
      "allowed: read parts of the scene one by one");
}

TEST(SceneMemory, BothReadersCountLobes) {
  const auto counted = [](const SceneUse& use) {
    std::size_t lobes = 0;
    for (const MaterialUse& material : use.materials) lobes += material.lobes.size();
    EXPECT_EQ(use.lobeCount, lobes);
    return lobes;
  };
  EXPECT_EQ(counted(sceneFromJson(R"({"format":"ltc-scene","version":1,"materials":[
      {"name":"a","roughness":[0,1]}, {"name":"b","roughness":{"values":[0.2,0.4]}}]})",
                                  {})),
            67u);
  GltfBuilder builder;
  builder.quad(builder.material({{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}}}}));
  EXPECT_EQ(counted(sceneFromGltf(builder.glb(), {})), 2u);
}

}  // namespace
}  // namespace ltcfit
