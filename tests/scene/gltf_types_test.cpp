// Types, enumerations and layouts that glTF does not have: refused by name, before anything is read by them.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "export/atomic_file.h"
#include "scene/gltf_scene.h"
#include "tests/scene/gltf_builder.h"

namespace ltcfit {
namespace {

using test::GltfBuilder;
using test::GltfJson;

constexpr const char* kComponents =
    "5120 (BYTE), 5121 (UNSIGNED_BYTE), 5122 (SHORT), 5123 (UNSIGNED_SHORT), 5125 (UNSIGNED_INT), 5126 "
    "(FLOAT)";

std::string messageOf(const GltfBuilder& builder) {
  try {
    sceneFromGltf(builder.glb(), {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

void expectRefused(const GltfBuilder& builder, const std::string& start, const std::string& words) {
  const std::string message = messageOf(builder);
  EXPECT_TRUE(message.starts_with(start)) << message << "\n, not " << start;
  EXPECT_NE(message.find(words), std::string::npos) << message << "\n, without " << words;
}

// One textured quad: accessors 0 positions, 1 coordinates, 2 indices; 3 a sparse one that nothing uses.
GltfBuilder quad() {
  GltfBuilder builder;
  const int texture = builder.texture(
      test::imageOf(2, 2,
                    [](std::size_t x, std::size_t) {
                      return std::array<std::uint8_t, 4>{0, static_cast<std::uint8_t>(100 + x), 0, 255};
                    }),
      {{"wrapS", 33071}, {"wrapT", 10497}, {"magFilter", 9729}, {"minFilter", 9987}});
  builder.quad(
      builder.material({{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", texture}}}}}}));
  const int at = builder.view(std::string("\0\0", 2));
  const int values = builder.view(std::string(8, '\0'));
  builder.push("accessors", {{"componentType", 5126},
                             {"count", 4},
                             {"type", "SCALAR"},
                             {"sparse",
                              {{"count", 1},
                               {"indices", {{"bufferView", at}, {"componentType", 5123}}},
                               {"values", {{"bufferView", values}}}}}});
  return builder;
}

const std::vector<GltfJson> kNoComponents{5124, 5127, 5128,  5129,         5130,   5131,   5119,    0,
                                          -1,   4,    -5126, 65536 + 5126, 5126.0, "5126", "FLOAT", nullptr};

TEST(GltfTypes, TheQuadIsRead) {
  EXPECT_EQ(messageOf(quad()), "accepted");
}

TEST(GltfTypes, ComponentTypesThatGltfHasNot) {
  for (std::size_t accessor = 0; accessor < 4; ++accessor) {
    const std::string name = "accessor " + std::to_string(accessor) + ": componentType is ";
    for (const GltfJson& type : kNoComponents) {
      GltfBuilder builder = quad();
      builder.json["accessors"][accessor]["componentType"] = type;
      expectRefused(builder, name + type.dump() + "; glTF has ", kComponents);
    }
    GltfBuilder builder = quad();
    builder.json["accessors"][accessor].erase("componentType");
    expectRefused(builder, name + "missing", kComponents);
  }
}

// Eight bytes of each number would be read where the block has four: at its end, beyond it.
TEST(GltfTypes, NoNumberIsReadBeyondItsBytes) {
  for (const int type : {5124, 5127, 5130}) {
    GltfBuilder builder;
    builder.mesh({{"attributes", {{"POSITION", builder.accessor("VEC3", type, test::Numbers(9), 3)}}}});
    builder.node({{"mesh", 0}});
    expectRefused(builder, "accessor 0: componentType is " + std::to_string(type), kComponents);
  }
}

TEST(GltfTypes, IndicesOfSparseAccessors) {
  for (const GltfJson& type : kNoComponents) {
    GltfBuilder builder = quad();
    builder.json["accessors"][3]["sparse"]["indices"]["componentType"] = type;
    expectRefused(builder, "accessor 3: sparse.indices: componentType is " + type.dump(),
                  "glTF has 5121 (UNSIGNED_BYTE), 5123 (UNSIGNED_SHORT), 5125 (UNSIGNED_INT)");
  }
  for (const int type : {5120, 5122, 5126}) {
    GltfBuilder builder = quad();
    builder.json["accessors"][3]["sparse"]["indices"]["componentType"] = type;
    expectRefused(builder, "accessor 3: sparse.indices: componentType", "UNSIGNED_INT");
  }
}

struct Change {
  const char* at;  // a JSON pointer
  GltfJson value;  // discarded: the field is erased
  std::string start;
  std::string words;
};

void expectAllRefused(const std::vector<Change>& changes) {
  for (const Change& change : changes) {
    GltfBuilder builder = quad();
    const GltfJson::json_pointer at(change.at);
    if (change.value.is_discarded()) {
      builder.json[at.parent_pointer()].erase(at.back());
    } else {
      builder.json[at] = change.value;
    }
    SCOPED_TRACE(std::string(change.at) + " " + change.value.dump());
    expectRefused(builder, change.start, change.words);
  }
}

TEST(GltfTypes, EnumerationsOfOtherObjects) {
  const std::string wraps = "33071 (CLAMP_TO_EDGE), 33648 (MIRRORED_REPEAT), 10497 (REPEAT)";
  expectAllRefused({
      {"/accessors/1/type", "VEC5", "accessor 1: type is \"VEC5\"", "VEC4, MAT2"},
      {"/accessors/0/type", 3, "accessor 0: type is 3", "SCALAR, VEC2"},
      {"/accessors/3/type", "vec3", "accessor 3: type", "VEC3"},
      {"/samplers/0/wrapS", 10496, "sampler 0: wrapS is 10496", wraps},
      {"/samplers/0/wrapS", 33069, "sampler 0: wrapS is 33069", wraps},  // OpenGL's CLAMP_TO_BORDER
      {"/samplers/0/wrapT", "REPEAT", "sampler 0: wrapT is \"REPEAT\"", wraps},
      {"/samplers/0/wrapT", 0, "sampler 0: wrapT is 0", wraps},
      {"/samplers/0/magFilter", 9987, "sampler 0: magFilter is 9987", "9728 (NEAREST), 9729 (LINEAR)"},
      {"/samplers/0/minFilter", 9727, "sampler 0: minFilter is 9727", "9987 (LINEAR_MIPMAP_LINEAR)"},
      {"/meshes/0/primitives/0/mode", 7, "mesh 0, primitive 0: mode is 7", "4 (TRIANGLES)"},
      {"/meshes/0/primitives/0/mode", -1, "mesh 0, primitive 0: mode is -1", "6 (TRIANGLE_FAN)"},
      {"/meshes/0/primitives/0/mode", "4", "mesh 0, primitive 0: mode is \"4\"", "0 (POINTS)"},
      {"/images/0/mimeType", "image/gif", "image 0: mimeType is 'image/gif'", "image/png, image/jpeg"},
      {"/images/0/mimeType", "png", "image 0: mimeType is 'png'", "image/ktx2"},
  });
}

TEST(GltfTypes, FieldsThatTinygltfWouldTakeTheDefaultFor) {
  const GltfJson gone(GltfJson::value_t::discarded);
  expectAllRefused({
      {"/accessors/0/bufferView", "0", "accessor 0: bufferView is not an integer", "from 0 on"},
      {"/accessors/0/bufferView", -1, "accessor 0: bufferView", ""},
      {"/accessors/0/byteOffset", -4, "accessor 0: byteOffset", ""},
      {"/accessors/0/byteOffset", 0.5, "accessor 0: byteOffset", ""},
      {"/accessors/0/count", -1, "accessor 0: count", ""},
      {"/accessors/0/count", gone, "accessor 0: count", ""},
      {"/accessors/0/normalized", 1, "accessor 0: normalized is not true or false", ""},
      {"/accessors/3/sparse", 1, "accessor 3: sparse is not an object", ""},
      {"/accessors/3/sparse/count", -1, "accessor 3: sparse: count", ""},
      {"/accessors/3/sparse/values", gone, "accessor 3: sparse: values", ""},
      {"/accessors/3/sparse/values/bufferView", -1, "accessor 3: sparse.values: bufferView", ""},
      {"/accessors/3/sparse/indices/byteOffset", "0", "accessor 3: sparse.indices: byteOffset", ""},
      {"/bufferViews/0/byteOffset", "4", "buffer view 0: byteOffset", ""},
      {"/bufferViews/0/buffer", gone, "buffer view 0: buffer is not", ""},
      {"/meshes/0/primitives/0/indices", "2", "mesh 0, primitive 0: indices", ""},
      {"/meshes/0/primitives/0/material", -2, "mesh 0, primitive 0: material", ""},
      {"/meshes/0/primitives/0/attributes/POSITION", -1, "mesh 0, primitive 0: POSITION", ""},
      {"/meshes/0/primitives/0/attributes", GltfJson::array(), "mesh 0, primitive 0: attributes", ""},
      {"/textures/0/sampler", "0", "texture 0: sampler", ""},
      {"/textures/0/source", 0.0, "texture 0: source", ""},
      {"/images/0/bufferView", "0", "image 0: bufferView", ""},
      {"/nodes/0/mesh", "0", "node 0: mesh", ""},
      {"/nodes/0/scale", {1, "2", 1}, "node 0: scale is not an array of numbers", ""},
      {"/nodes/0/matrix", "1", "node 0: matrix", ""},
      {"/nodes/0/children", {0.5}, "node 0: children", ""},
      {"/scenes/0/nodes", 0, "scene 0: nodes", ""},
      {"/scene", "0", "the file: scene", ""},
      {"/accessors", GltfJson::object(), "'accessors' is not an array", ""},
      {"/samplers/0", 1, "sampler 0 is not an object", ""},
  });
}

TEST(GltfTypes, StridesThatGltfHasNot) {
  for (const GltfJson& stride : std::vector<GltfJson>{1, 2, 3, 5, 253, 256, 1 << 20, -4, 4.0, "12"}) {
    GltfBuilder builder = quad();
    builder.json["bufferViews"][1]["byteStride"] = stride;
    expectRefused(builder, "buffer view 1: byteStride (" + stride.dump() + ")",
                  "a multiple of 4 from 4 to 252");
  }
}

// Buffer views in the order of quad(): 0 the image, 1 positions, 2 coordinates, 3 indices, 4 and 5 sparse.
TEST(GltfTypes, StridesThatDoNotFitTheirAccessor) {
  expectAllRefused({
      {"/bufferViews/1/byteStride", 8, "mesh 0, primitive 0: accessor 0: elements of 12 bytes overlap",
       "is 8"},
      {"/bufferViews/2/byteStride", 4, "mesh 0, primitive 0: accessor 1: elements of 8 bytes overlap",
       "is 4"},
      {"/bufferViews/3/byteStride", 4, "mesh 0, primitive 0: accessor 2: buffer view 3 has a byteStride (4)",
       "attributes of vertices alone"},
  });
  GltfBuilder builder = quad();
  builder.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 3;
  builder.json["accessors"][3]["type"] = "VEC2";
  EXPECT_EQ(messageOf(builder), "accepted");
  builder.json["bufferViews"][4]["byteStride"] = 4;
  expectRefused(builder, "mesh 0, primitive 0: accessor 3: sparse.indices: buffer view 4", "byteStride (4)");
  // what lies as close as it can, and the 0 of some writers
  for (const int stride : {0, 12}) {
    GltfBuilder tight = quad();
    tight.json["bufferViews"][1]["byteStride"] = stride;
    EXPECT_EQ(messageOf(tight), "accepted");
  }
}

TEST(GltfTypes, NumbersOffTheirMultiples) {
  const auto moved = [](std::size_t accessor, std::size_t view, std::size_t ofAccessor, std::size_t ofView) {
    GltfBuilder builder = quad();
    builder.view(std::string(16, '\0'));
    GltfJson& v = builder.json["bufferViews"][view];
    v["byteOffset"] = v["byteOffset"].get<std::size_t>() + ofView;
    v["byteLength"] = v["byteLength"].get<std::size_t>() + 4;
    builder.json["accessors"][accessor]["byteOffset"] = ofAccessor;
    return builder;
  };
  const std::string start = "mesh 0, primitive 0: accessor ";
  for (const std::size_t by : {1u, 2u, 3u}) {
    expectRefused(moved(0, 1, by, 0), start + "0: byteOffset " + std::to_string(by), "4 bytes of a number");
    expectRefused(moved(0, 1, 0, by), start + "0: byteOffset 0, in a buffer view from",
                  "4 bytes of a number");
    expectRefused(moved(1, 2, by, 0), start + "1: byteOffset", "4 bytes of a number");
  }
  expectRefused(moved(2, 3, 1, 0), start + "2: byteOffset 1", "2 bytes of a number");
  EXPECT_EQ(messageOf(moved(2, 3, 2, 0)), "accepted");
  // two that add up
  expectRefused(moved(0, 1, 2, 2), start + "0: byteOffset 2", "4 bytes of a number");
}

}  // namespace
}  // namespace ltcfit
