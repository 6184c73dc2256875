// Damaged scenes: a reader gives a scene or an InputError, soon, whatever the bytes are. Run under sanitizers
// too (tests/fuzz).
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "export/atomic_file.h"
#include "ggx/random.h"
#include "scene/gltf_scene.h"
#include "scene/json_scene.h"
#include "scene/texel_image.h"

namespace ltcfit {
namespace {

const std::filesystem::path kFolder = std::filesystem::path(LTCFIT_DATA_DIR) / "scenes";

// Reads a heap block of exactly this length, so that a sanitizer sees what lies beyond. Whether it was
// accepted.
bool read(std::string_view bytes, bool json = false) {
  const auto block = std::make_unique<char[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), block.get());
  const std::string_view exact(block.get(), bytes.size());
  try {
    const SceneUse use = json ? sceneFromJson(exact, kFolder) : sceneFromGltf(exact, kFolder);
    for (const MaterialUse& material : use.materials) {
      double sum = 0.0;
      for (const LobeUse& lobe : material.lobes) {
        EXPECT_TRUE(lobe.alphaX >= lobe.alphaY && lobe.alphaX <= 1.0 && lobe.alphaY >= 0.0);
        EXPECT_TRUE(lobe.f0 >= 0.0 && lobe.f0 <= 1.0 && lobe.f90 >= 0.0 && lobe.f90 <= 1.0);
        sum += lobe.weight;
      }
      EXPECT_NEAR(sum, material.area, 1e-6 * material.area);  // some thousand additions
      EXPECT_TRUE(material.area >= 0.0 && material.area < 1.0 + 1e-9);
    }
    return true;
  } catch (const InputError& error) {
    EXPECT_GT(std::strlen(error.what()), 5u);
    EXPECT_LT(std::strlen(error.what()), 500u);
    return false;
  }
}

std::string fixture(const char* name) {
  return readFile((kFolder / name).string());
}

class SceneRobustness : public testing::TestWithParam<const char*> {
 protected:
  bool json() const { return std::string_view(GetParam()) == "lobby.json"; }
};

TEST_P(SceneRobustness, CutOff) {
  const std::string bytes = fixture(GetParam());
  ASSERT_TRUE(read(bytes, json()));
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    // white space at the end of a text may go
    const bool whole = bytes.find_first_not_of(" \n", n) == std::string::npos;
    EXPECT_EQ(read(std::string_view(bytes).substr(0, n), json()), whole) << n << " of " << bytes.size();
  }
}

TEST_P(SceneRobustness, SingleBits) {
  std::string bytes = fixture(GetParam());
  Random random(7);
  for (int i = 0; i < 4000; ++i) {
    const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(bytes.size()));
    const int bit = static_cast<int>(random.uniform() * 8.0);
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
    read(bytes, json());
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
  }
}

TEST_P(SceneRobustness, NumbersInTheText) {
  // every number replaced by absurd ones
  const std::string bytes = fixture(GetParam());
  const std::size_t end = std::min<std::size_t>(bytes.size(), 4096);
  for (std::size_t at = 0; at < end;) {
    if (bytes[at] < '0' || bytes[at] > '9' || at == 0 || std::strchr(":[,", bytes[at - 1]) == nullptr) {
      ++at;
      continue;
    }
    std::size_t stop = at;
    while (stop < bytes.size() && std::strchr("0123456789.e-+", bytes[stop]) != nullptr &&
           bytes[stop] != '\0')
      ++stop;
    for (const char* number :
         {"0", "-1", "7", "65536", "2147483647", "4294967295", "4294967296", "1e300", "-1e300",
          "18446744073709551615", "99999999999999999999999", "null", "\"x\"", "[]", "{}"})
      read(std::string(bytes).replace(at, stop - at, number), json());
    at = stop;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneRobustness,
                         testing::Values("lamp.glb", "discs.gltf", "metal_rough.gltf", "clearcoat.gltf",
                                         "lobby.json"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

std::string littleEndian32(std::size_t value) {
  std::string out;
  for (int i = 0; i < 4; ++i) out += static_cast<char>(value >> (8 * i) & 255);
  return out;
}

TEST(GltfRobustness, GlbChunks) {
  const std::string json = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4}]})";
  const auto glb = [](const std::string& body, std::size_t extra = 0) {
    return "glTF" + littleEndian32(2) + littleEndian32(12 + body.size() + extra) + body;
  };
  const std::string text = littleEndian32(json.size()) + "JSON" + json;
  const std::string four = littleEndian32(4) + std::string("BIN\0abcd", 8);
  EXPECT_TRUE(read(glb(text + four)));
  // an unknown chunk is passed over, what follows the length too
  EXPECT_TRUE(read(glb(text + littleEndian32(0) + "XYZ " + four)));
  EXPECT_TRUE(read(glb(text + four) + "trailing"));
  EXPECT_FALSE(read(glb(text)));            // the buffer is missing
  EXPECT_FALSE(read(glb(text + four, 1)));  // longer than the file
  EXPECT_FALSE(read(glb(text + littleEndian32(8) + std::string("BIN\0abcd", 8))));
  EXPECT_FALSE(read(glb(text + littleEndian32(0xffffffff) + std::string("BIN\0", 4))));
  EXPECT_FALSE(read(glb(four + text)));  // JSON is not the first
  EXPECT_FALSE(read(glb(text + "abc")));
  EXPECT_FALSE(read("glTF" + littleEndian32(1) + littleEndian32(12)));  // another version
  EXPECT_FALSE(read("glTF" + littleEndian32(2) + littleEndian32(12)));  // no chunk
  EXPECT_FALSE(read("glTF"));
}

TEST(GltfRobustness, TextThatIsNoGltf) {
  for (const char* text :
       {"", "{}", "[]", "null", "{\"asset\":1}", "{\"asset\":{}}", "{\"asset\":{\"version\":2}}",
        "{\"asset\":{\"version\":\"1.0\"}}", "{\"asset\":{\"version\":\"2.0\"},\"meshes\":{}}",
        "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[3]}",
        "{\"asset\":{\"version\":\"2.0\"},\"images\":[3]}",
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[3]}",
        "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{\"primitives\":[3]}]}",
        "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[3]}"})
    EXPECT_FALSE(read(text)) << text;
  EXPECT_TRUE(read("{\"asset\":{\"version\":\"2.0\"}}"));
  using namespace std::string_literals;
  EXPECT_TRUE(read("{\"asset\":{\"version\":\"2.0\"}}\0\0"s));
  EXPECT_FALSE(read("{\"asset\":{\"version\"\0:\"2.0\"}}"s));
}

TEST(GltfRobustness, DeepNestingIsRefused) {
  const auto start = std::chrono::steady_clock::now();
  for (const char* key : {"extensions", "materials", "extras", "meshes"}) {
    std::string text = std::string("{\"asset\":{\"version\":\"2.0\"},\"") + key + "\":";
    for (int i = 0; i < 1000000; ++i) text += "[";
    EXPECT_FALSE(read(text)) << key;
    text.append(1000000, ']');
    EXPECT_FALSE(read(text + "}")) << key;
    std::string objects = "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{\"extensions\":";
    for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
    EXPECT_FALSE(read(objects)) << key;
  }
  // a pass over some megabytes, under sanitizers too
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 60.0);
}

TEST(GltfRobustness, ManyMembersTakeOnePass) {
  const auto start = std::chrono::steady_clock::now();
  std::string text = "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{\"extensions\":{";
  for (int i = 0; i < 200000; ++i) text.append("\"").append(std::to_string(i)).append("\":{},");
  text += "\"x\":{}}}]}";
  EXPECT_TRUE(read(text));
  std::string nodes = "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}";
  for (int i = 0; i < 200000; ++i) nodes += ",{}";
  EXPECT_TRUE(read(nodes + "]}"));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 60.0);
}

TEST(GltfRobustness, ExtrasMayHoldAnything) {
  const std::string start = "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{\"extras\":";
  for (const char* extras :
       {"4294967296", "{\"a\":[1e9,99999999999],\"extras\":-5000000000}", "[]", "\"x\""}) {
    EXPECT_TRUE(read(start + extras + "}]}")) << extras;
    EXPECT_FALSE(read(start + extras + ",\"alphaCutoff\":4294967296}]}")) << extras;
  }
}

TEST(GltfRobustness, DamagedImages) {
  for (const char* name : {"discs.png", "metal_rough.jpg"}) {
    const std::string bytes = fixture(name);
    Random random(9);
    const auto decode = [](std::string_view damaged) {
      const auto block = std::make_unique<char[]>(damaged.size());
      std::copy(damaged.begin(), damaged.end(), block.get());
      try {
        const TexelImage image = decodeTexels({block.get(), damaged.size()}, "p");
        EXPECT_EQ(image.texels.size(), image.width * image.height);
      } catch (const InputError&) {
      }
    };
    for (std::size_t n = 0; n < bytes.size(); ++n) decode(std::string_view(bytes).substr(0, n));
    for (std::size_t at = 0; at < bytes.size(); ++at)
      for (int bit = 0; bit < 8; ++bit) {
        std::string damaged = bytes;
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
        decode(damaged);
      }
    for (int i = 0; i < 2000; ++i) {
      std::string damaged = bytes;
      for (int k = 0; k < 4; ++k)
        damaged[static_cast<std::size_t>(random.uniform() * static_cast<double>(bytes.size()))] =
            static_cast<char>(static_cast<int>(random.uniform() * 256.0));
      decode(damaged);
    }
  }
}

}  // namespace
}  // namespace ltcfit
