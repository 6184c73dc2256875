// Areas of surfaces, and what nodes and accessors may do.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "export/atomic_file.h"
#include "scene/gltf_accessor.h"
#include "scene/gltf_surfaces.h"
#include "tests/scene/gltf_builder.h"

namespace ltcfit {
namespace {

using test::GltfBuilder;
using test::GltfJson;
using test::Numbers;

// float coordinates
constexpr double kRounding = 1e-6;

const Numbers kSquare{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

struct Result {
  std::vector<GltfSurface> surfaces;
  std::vector<std::string> notes;
  double area() const {
    double sum = 0.0;
    for (const GltfSurface& surface : surfaces) sum += surface.area;
    return sum;
  }
};

Result read(const GltfBuilder& builder) {
  const GltfFile file = parseGltf(builder.glb(), {});
  GltfAccessors accessors(file);
  Result out;
  out.surfaces = surfacesOf(file, accessors, out.notes);
  for (GltfSurface& surface : out.surfaces) surface.primitive = nullptr;  // goes with the file
  return out;
}

void refused(const GltfBuilder& builder, const std::string& word) {
  try {
    read(builder);
    ADD_FAILURE() << "accepted; expected: " << word;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

// A square of two triangles as mesh 0, without a node.
GltfBuilder square() {
  GltfBuilder builder;
  builder.mesh({{"attributes", {{"POSITION", builder.vec3(kSquare)}}},
                {"indices", builder.indices({0, 1, 2, 0, 2, 3})}});
  return builder;
}

TEST(GltfSurfaces, AreaFollowsTransforms) {
  const auto area = [](const GltfJson& node) {
    GltfBuilder builder = square();
    GltfJson all = node;
    all["mesh"] = 0;
    builder.node(all);
    return read(builder).area();
  };
  EXPECT_NEAR(area(GltfJson::object()), 1.0, kRounding);
  EXPECT_NEAR(area({{"translation", {5, 6, 7}}}), 1.0, kRounding);
  EXPECT_NEAR(area({{"scale", {2, 3, 100}}}), 6.0, kRounding);
  EXPECT_NEAR(area({{"scale", {-2, 3, 0}}}), 6.0, kRounding);
  // turned by 90 degrees about x
  EXPECT_NEAR(area({{"rotation", {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}, {"scale", {2, 3, 5}}}), 6.0,
              kRounding);
  EXPECT_NEAR(area({{"rotation", {0, 0, 0, 0}}}), 1.0, kRounding);
  // sheared by columns (2, 0, 0) and (1, 3, 4)
  EXPECT_NEAR(area({{"matrix", {2, 0, 0, 0, 1, 3, 4, 0, 0, 0, 1, 0, 9, 9, 9, 1}}}), 10.0, kRounding);
}

TEST(GltfSurfaces, ParentsAndInstancesAddUp) {
  GltfBuilder builder = square();
  builder.push("nodes", {{"mesh", 0}, {"scale", {2, 1, 1}}});
  builder.node(
      {{"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}, {"scale", {3, 1, 1}}, {"children", {0}}});
  builder.node({{"mesh", 0}});
  // the child is scaled by 2 and 3 along x before the parent turns it
  EXPECT_NEAR(read(builder).area(), 6.0 + 1.0, kRounding);
}

TEST(GltfSurfaces, StripsFansAndNoIndices) {
  const auto area = [](int mode, const Numbers& positions) {
    GltfBuilder builder;
    builder.mesh({{"attributes", {{"POSITION", builder.vec3(positions)}}}, {"mode", mode}});
    builder.node({{"mesh", 0}});
    return read(builder);
  };
  const Numbers strip{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 3, 0};
  EXPECT_NEAR(area(5, strip).area(), 0.5 + 0.5 + 1.0, kRounding);
  EXPECT_NEAR(area(6, kSquare).area(), 1.0, kRounding);
  EXPECT_NEAR(area(4, kSquare).area(), 0.5, kRounding);  // the fourth vertex is of no triangle
  const Result lines = area(1, kSquare);
  EXPECT_TRUE(lines.surfaces.empty());
  ASSERT_EQ(lines.notes.size(), 1u);
}

TEST(GltfSurfaces, IndicesOfEveryType) {
  for (const int type : {5121, 5123, 5125}) {
    GltfBuilder builder;
    GltfJson primitive{{"attributes", {{"POSITION", builder.vec3(kSquare)}}}};
    if (type == 5121)
      primitive["indices"] = builder.accessor("SCALAR", type, std::vector<std::uint8_t>{0, 1, 2}, 1);
    if (type == 5123)
      primitive["indices"] = builder.accessor("SCALAR", type, std::vector<std::uint16_t>{0, 1, 2}, 1);
    if (type == 5125)
      primitive["indices"] = builder.accessor("SCALAR", type, std::vector<std::uint32_t>{0, 1, 2}, 1);
    builder.mesh(primitive);
    builder.node({{"mesh", 0}});
    EXPECT_NEAR(read(builder).area(), 0.5, kRounding) << type;
  }
}

TEST(GltfSurfaces, DefaultSceneOnly) {
  GltfBuilder builder = square();
  builder.node({{"mesh", 0}});
  builder.push("nodes", {{"mesh", 0}, {"scale", {2, 2, 2}}});
  builder.push("scenes", {{"nodes", {1, 0}}});
  EXPECT_NEAR(read(builder).area(), 1.0, kRounding);
  builder.json["scene"] = 1;
  EXPECT_NEAR(read(builder).area(), 5.0, kRounding);
  // all scenes, each node once
  builder.json.erase("scene");
  EXPECT_NEAR(read(builder).area(), 5.0, kRounding);
  builder.json.erase("scenes");
  EXPECT_NEAR(read(builder).area(), 5.0, kRounding);
}

TEST(GltfSurfaces, NodesThatAreNoTree) {
  GltfBuilder builder = square();
  builder.json["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"children", {0}}}};
  builder.json["scenes"][0]["nodes"] = {0};
  refused(builder, "its own ancestor");
  builder.json["nodes"] = GltfJson::array({{{"children", {0}}}});
  refused(builder, "node 0 is its own ancestor");
  builder.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
  refused(builder, "node 2 has two parents");
  builder.json["nodes"] = GltfJson::array({{{"children", {7}}}});
  refused(builder, "node 7 of 1");
  builder.json["nodes"] = GltfJson::array({{{"mesh", 1}}});
  refused(builder, "mesh 1 of 1");
  builder.json["nodes"] = GltfJson::array({{{"mesh", 0}, {"matrix", {1, 2}}}});
  refused(builder, "matrix of 2");
  builder.json["nodes"] = GltfJson::array({{{"mesh", 0}, {"rotation", {1, 2}}}});
  refused(builder, "rotation of 2");
  builder.json["scenes"][0]["nodes"] = {3};
  refused(builder, "node 3 of 1");
  builder.json["scene"] = 4;
  refused(builder, "scene 4 of 1");
}

TEST(GltfSurfaces, DeepTreesAreRead) {
  GltfBuilder builder = square();
  constexpr int kDepth = 100000;
  GltfJson nodes = GltfJson::array();
  for (int i = 0; i + 1 < kDepth; ++i) nodes.push_back({{"children", {i + 1}}});
  nodes.push_back({{"mesh", 0}});
  builder.json["nodes"] = nodes;
  builder.json["scenes"][0]["nodes"] = {0};
  EXPECT_NEAR(read(builder).area(), 1.0, kRounding);
}

TEST(GltfSurfaces, VariantsAreShownToo) {
  GltfBuilder builder = square();
  for (int i = 0; i < 3; ++i) builder.material(GltfJson::object());
  builder.json["meshes"][0]["primitives"][0]["material"] = 1;
  builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
      {{"material", 1}, {"variants", {0}}}, {{"material", 2}, {"variants", {1}}}};
  builder.node({{"mesh", 0}});
  const Result result = read(builder);
  ASSERT_EQ(result.surfaces.size(), 1u);
  EXPECT_EQ(result.surfaces[0].materials, (std::vector<int>{1, 2}));
  EXPECT_EQ(result.notes.size(), 1u);
}

TEST(GltfSurfaces, BadGeometry) {
  const auto with = [](const std::function<void(GltfBuilder&)>& change) {
    GltfBuilder builder = square();
    builder.node({{"mesh", 0}});
    change(builder);
    return builder;
  };
  refused(with([](GltfBuilder& b) {
            b.json["meshes"][0]["primitives"][0]["indices"] = b.indices({0, 1, 9});
          }),
          "vertex 9 of 4");
  refused(with([](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["material"] = 0; }),
          "material 0 of 0");
  refused(with([](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 77; }),
          "accessor 77");
  refused(with([](GltfBuilder& b) { b.json["accessors"][0]["count"] = 5; }), "do not fit");
  refused(with([](GltfBuilder& b) { b.json["accessors"][0]["count"] = 2147483647; }), "more than");
  refused(with([](GltfBuilder& b) { b.json["accessors"][0]["count"] = 4294967296; }), "beyond every index");
  refused(with([](GltfBuilder& b) { b.json["accessors"][0]["byteOffset"] = 4; }), "do not fit");
  refused(with([](GltfBuilder& b) { b.json["accessors"][0]["byteOffset"] = 2147483647; }), "do not fit");
  refused(with([](GltfBuilder& b) { b.json["accessors"][0]["bufferView"] = 5; }), "buffer view 5");
  refused(with([](GltfBuilder& b) { b.json["accessors"][0]["type"] = "VEC2"; }),
          "does not have 3 components");
  refused(with([](GltfBuilder& b) {
            b.json["accessors"][0].erase("bufferView");
            b.json["accessors"][0]["count"] = 1 << 27;
          }),
          "without data");
  refused(with([](GltfBuilder& b) { b.json["accessors"][1]["componentType"] = 5126; }),
          "does not hold indices");
  refused(with([](GltfBuilder& b) { b.json["bufferViews"][0]["byteLength"] = 1000; }),
          "buffer view 0 has 1000 bytes");
  refused(with([](GltfBuilder& b) { b.json["bufferViews"][0]["buffer"] = 1; }), "buffer 1 of 1");
  GltfBuilder infinite;
  Numbers positions = kSquare;
  positions[0] = std::numeric_limits<float>::infinity();
  infinite.mesh({{"attributes", {{"POSITION", infinite.vec3(positions)}}}});
  infinite.node({{"mesh", 0}});
  refused(infinite, "not finite");
}

TEST(GltfSurfaces, ManyPlacementsAreRefusedSoon) {
  GltfBuilder builder;
  std::vector<std::uint16_t> indices(30000, 0);
  builder.mesh(
      {{"attributes", {{"POSITION", builder.vec3(kSquare)}}}, {"indices", builder.indices(indices)}});
  for (int i = 0; i < 30000; ++i) builder.node({{"mesh", 0}});
  refused(builder, "more than 268435456 triangles");
}

TEST(GltfAccessors, SparseNormalizedAndStrided) {
  GltfBuilder builder;
  // bytes apart, normalized: 127 is 1, -128 counts as -1
  std::string bytes;
  for (const int v : {127, 0, -128, 99, 0, 127, 0, 99}) bytes += static_cast<char>(v);
  const int view = builder.view(bytes);
  builder.json["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 4;
  builder.push(
      "accessors",
      {{"bufferView", view}, {"componentType", 5120}, {"normalized", true}, {"count", 2}, {"type", "VEC3"}});
  const int values = builder.view(std::string("\0\0\200\77\0\0\0\100", 8));  // 1.0f, 2.0f
  const int at = builder.view(std::string("\3\1", 2));
  builder.push("accessors", {{"componentType", 5126},
                             {"count", 4},
                             {"type", "SCALAR"},
                             {"sparse",
                              {{"count", 2},
                               {"indices", {{"bufferView", at}, {"componentType", 5121}}},
                               {"values", {{"bufferView", values}}}}}});
  const GltfFile file = parseGltf(builder.glb(), {});
  GltfAccessors accessors(file);
  EXPECT_EQ(accessors.vectors(0, 3, "test"), (std::vector<float>{1, 0, -1, 0, 1, 0}));
  EXPECT_EQ(accessors.vectors(1, 1, "test"), (std::vector<float>{0, 2, 0, 1}));
  builder.json["accessors"][1]["count"] = 3;
  const GltfFile beyond = parseGltf(builder.glb(), {});
  EXPECT_THROW(GltfAccessors(beyond).vectors(1, 1, "test"), InputError);
}

}  // namespace
}  // namespace ltcfit
