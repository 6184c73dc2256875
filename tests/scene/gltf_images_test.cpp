// Where images and buffers come from, and what is refused of them.
#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>
#include <zlib.h>

#include <filesystem>
#include <string>
#include <vector>

#include "export/atomic_file.h"
#include "scene/gltf_scene.h"
#include "scene/gltf_uri.h"
#include "scene/texel_image.h"
#include "tests/scene/gltf_builder.h"

namespace ltcfit {
namespace {

namespace fs = std::filesystem;
using test::GltfBuilder;
using test::GltfJson;
using test::imageOf;
using test::pngOf;

using Rgba = std::array<std::uint8_t, 4>;

TexelImage flat(std::uint8_t green, std::size_t size = 4) {
  return imageOf(size, size, [=](std::size_t, std::size_t) { return Rgba{0, green, 0, 255}; });
}

template <typename Call>
void refused(const Call& call, const std::string& word) {
  try {
    call();
    ADD_FAILURE() << "accepted; expected: " << word;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

// A folder of its own, removed at the end.
class GltfImages : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("ltcfit-gltf-images-" + std::to_string(getpid()));
    fs::create_directories(folder_ / "sub");
  }
  void TearDown() override { fs::remove_all(folder_); }

  // A quad whose roughness is that of an image given by its JSON.
  static GltfBuilder quadOf(const GltfJson& image) {
    GltfBuilder builder;
    builder.push("images", image);
    builder.push("textures", {{"source", 0}});
    builder.quad(builder.material(
        {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"metallicRoughnessTexture", {{"index", 0}}}}}}));
    return builder;
  }
  double alphaOf(const GltfJson& image) const {
    return sceneFromGltf(quadOf(image).glb(), folder_).materials.at(0).lobes.at(0).alphaX;
  }

  fs::path folder_;
};

constexpr double kRounding = 1e-9;

TEST_F(GltfImages, FromEverywhere) {
  const std::string png = pngOf(flat(51));
  EXPECT_NEAR(alphaOf({{"uri", "data:image/png;base64," + test::base64(png)}}), 0.04, kRounding);
  EXPECT_NEAR(alphaOf({{"uri", "data:application/whatever;base64," + test::base64(png)}}), 0.04, kRounding);
  writeFileAtomically((folder_ / "a +%.png").string(), png);
  EXPECT_NEAR(alphaOf({{"uri", "a%20+%25.png"}}), 0.04, kRounding);
  EXPECT_NEAR(alphaOf({{"uri", "a%20%2b%25.png"}}), 0.04, kRounding);
  EXPECT_NEAR(alphaOf({{"uri", "sub/../a +%25.png"}}), 0.04, kRounding);
  const GltfBuilder builder = quadOf({{"uri", "../a +%25.png"}});
  EXPECT_NEAR(sceneFromGltf(builder.gltf(), folder_ / "sub").materials.at(0).lobes.at(0).alphaX, 0.04,
              kRounding);
}

TEST_F(GltfImages, WhatIsNotBesideIt) {
  refused([&] { alphaOf({{"uri", "gone.png"}}); }, "'gone.png', which it names, is not a file");
  refused([&] { alphaOf({{"uri", "sub"}}); }, "not a file");
  refused([&] { alphaOf({{"uri", "/dev/zero"}}); }, "absolute");
  refused([&] { alphaOf({{"uri", "../../../../../../../../dev/zero"}}); }, "not a file");
  refused([&] { alphaOf({{"uri", "https://example.org/a.png"}}); }, "not a file beside it");
  refused([&] { alphaOf({{"uri", "file:a.png"}}); }, "not a file beside it");
  refused([&] { alphaOf({{"uri", "data:image/png,abc"}}); }, "not base64");
  refused([&] { alphaOf({{"uri", "a%00.png"}}); }, "not a file");
  refused([&] { alphaOf({{"uri", std::string(1000, 'x')}}); }, "xxx...");
  refused([&] { alphaOf(GltfJson::object()); }, "buffer view -1");
}

TEST_F(GltfImages, WhatIsNotNeededIsNotRead) {
  GltfBuilder builder = quadOf({{"uri", "data:image/png;base64," + test::base64(pngOf(flat(51)))}});
  builder.push("images", {{"uri", "gone.png"}});
  builder.push("textures", {{"source", 1}});
  builder.json["materials"][0]["normalTexture"] = {{"index", 1}};
  EXPECT_EQ(sceneFromGltf(builder.glb(), folder_).materials.size(), 1u);
}

TEST_F(GltfImages, BuffersBesideIt) {
  GltfBuilder builder = quadOf({{"uri", "data:image/png;base64," + test::base64(pngOf(flat(51)))}});
  writeFileAtomically((folder_ / "data.bin").string(), builder.data + "more");
  builder.json["buffers"] = GltfJson::array({{{"byteLength", builder.data.size()}, {"uri", "data.bin"}}});
  EXPECT_EQ(sceneFromGltf(builder.json.dump(), folder_).materials.at(0).texels, 16u);
  const auto with = [&](const GltfJson& buffer) {
    builder.json["buffers"] = GltfJson::array({buffer});
    sceneFromGltf(builder.json.dump(), folder_);
  };
  refused([&] { with({{"byteLength", builder.data.size() + 5}, {"uri", "data.bin"}}); }, "data.bin has");
  refused([&] { with({{"byteLength", 10}, {"uri", "data.bin"}}); }, "buffer view");
  refused([&] { with({{"byteLength", 10}, {"uri", "gone.bin"}}); }, "gone.bin");
  refused([&] { with({{"byteLength", 10}}); }, "neither a URI");
  refused([&] { with({{"uri", "data.bin"}}); }, "no byteLength");
  refused([&] { with({{"byteLength", 2000000000}, {"uri", "data.bin"}}); }, "more than 1073741824 bytes");
  refused(
      [&] {
        with({{"byteLength", 1000}, {"uri", "data:application/octet-stream;base64,AAAA"}});
      },
      "fewer");
  refused([&] { with({{"byteLength", 3}, {"uri", "data:image/tiff;base64,AAAA"}}); }, "unknown kind");
  builder.json.erase("buffers");
  refused([&] { sceneFromGltf(builder.json.dump(), folder_); }, "buffer 0 of 0");
}

TEST_F(GltfImages, IndicesOutOfRange) {
  GltfBuilder builder = quadOf({{"uri", "data:image/png;base64," + test::base64(pngOf(flat(51)))}});
  builder.json["textures"][0]["source"] = 4;
  refused([&] { sceneFromGltf(builder.glb(), folder_); }, "image 4 of 1");
  builder.json["textures"][0] = GltfJson::object();
  refused([&] { sceneFromGltf(builder.glb(), folder_); }, "texture 0 has no image");
  builder.json["textures"][0] = {{"source", 0}, {"sampler", 2}};
  refused([&] { sceneFromGltf(builder.glb(), folder_); }, "sampler 2 of 0");
  builder.json.erase("textures");
  refused([&] { sceneFromGltf(builder.glb(), folder_); }, "texture 0 of 0");
}

TEST(TexelImage, PngRoundTrip) {
  const TexelImage image = imageOf(5, 3, [](std::size_t x, std::size_t y) {
    const auto v = static_cast<std::uint8_t>(16 * x + y);
    return Rgba{v, static_cast<std::uint8_t>(255 - v), 7, static_cast<std::uint8_t>(x == 0 ? 0 : 200)};
  });
  const TexelImage back = decodeTexels(pngOf(image), "p");
  EXPECT_EQ(back.width, 5u);
  EXPECT_EQ(back.height, 3u);
  EXPECT_EQ(back.texels, image.texels);
}

TEST(TexelImage, SixteenBitsAndGrey) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = 2;
  header.height = 1;
  header.format = PNG_FORMAT_GRAY;
  const std::array<std::uint8_t, 2> grey{10, 200};
  std::string bytes(1000, '\0');
  png_alloc_size_t size = bytes.size();
  ASSERT_NE(png_image_write_to_memory(&header, bytes.data(), &size, 0, grey.data(), 0, nullptr), 0);
  EXPECT_EQ(decodeTexels(bytes.substr(0, size), "p").texels,
            (std::vector<Rgba>{{10, 10, 10, 255}, {200, 200, 200, 255}}));
  header.format = PNG_FORMAT_LINEAR_RGB;
  const std::array<std::uint16_t, 6> deep{0, 0x80ff, 0xffff, 1, 2, 3};
  size = bytes.size();
  ASSERT_NE(png_image_write_to_memory(&header, bytes.data(), &size, 0, deep.data(), 0, nullptr), 0);
  EXPECT_EQ(decodeTexels(bytes.substr(0, size), "p").texels.at(0), (Rgba{0, 0x80, 255, 255}));
}

void putBigEndian32(std::string& bytes, std::size_t at, std::size_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i) & 255);
}

// The width and height in the header, with its checksum.
std::string resized(std::string png, std::size_t width, std::size_t height) {
  putBigEndian32(png, 16, width);
  putBigEndian32(png, 20, height);
  putBigEndian32(png, 29, crc32(0, reinterpret_cast<const Bytef*>(png.data()) + 12, 17));
  return png;
}

TEST(TexelImage, HugeHeadersAreRefusedBeforeDecoding) {
  const std::string png = pngOf(flat(1, 8));
  refused([&] { decodeTexels(resized(png, 60000, 60000), "p"); },
          "60000 x 60000 texels; a side may have 16384");
  refused([&] { decodeTexels(resized(png, 0x7fffffff, 1), "p"); }, "2147483647 x 1");
  refused([&] { decodeTexels(resized(png, 16384, 16384), "p"); }, "cannot hold");
  refused([&] { decodeTexels(resized(png, 0, 5), "p"); }, "damaged");
  refused([&] { decodeTexels(png, "p", 63); }, "images have more than");
  EXPECT_EQ(decodeTexels(png, "p", 64).texels.size(), 64u);
  std::string jpeg = readFile(std::string(LTCFIT_DATA_DIR) + "/scenes/metal_rough.jpg");
  const std::size_t frame = jpeg.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  for (std::size_t i = 5; i < 9; ++i) jpeg[frame + i] = '\x7f';
  refused([&] { decodeTexels(jpeg, "p"); }, "a side may have");
  for (std::size_t i = 5; i < 9; ++i) jpeg[frame + i] = '\x30';
  refused([&] { decodeTexels(jpeg, "p"); }, "cannot hold");
}

TEST(TexelImage, WhatIsNoImage) {
  refused([&] { decodeTexels("GIF89a........................", "p"); }, "neither a PNG nor a JPEG");
  refused([&] { decodeTexels("", "p"); }, "neither");
  EXPECT_EQ(unreadableKind("RIFF\1\2\3\4WEBPVP8 "), "WebP");
  EXPECT_EQ(unreadableKind(std::string("\0\0\0\x20"
                                       "ftypavif",
                                       12)),
            "AVIF");
  EXPECT_EQ(unreadableKind("DDS |"), "DDS");
  EXPECT_EQ(unreadableKind("RIFF"), "");
}

TEST(TexelImage, UniformIsUniform) {
  const TexelImage image = uniformTexels();
  std::array<double, 4> mean{};
  std::size_t corner = 0;
  for (const Rgba& texel : image.texels) {
    for (std::size_t c = 0; c < 4; ++c)
      mean[c] += texel[c] / 255.0 / static_cast<double>(image.texels.size());
    corner += texel[0] < 64 && texel[1] < 64 && texel[2] < 64 ? 1 : 0;
  }
  for (const double m : mean) EXPECT_NEAR(m, 0.5, 0.002);  // 4096 points of discrepancy about 1/1000
  EXPECT_NEAR(static_cast<double>(corner) / static_cast<double>(image.texels.size()), 1.0 / 64.0, 0.002);
}

TEST(Luminance, WhiteIsOne) {
  EXPECT_NEAR(luminance({1.0, 1.0, 1.0}), 1.0, 1e-12);
  EXPECT_EQ(linearFromSrgb8(0), 0.0);
  EXPECT_EQ(linearFromSrgb8(255), 1.0);
}

TEST(GltfUri, ShortenedBetweenCharacters) {
  EXPECT_EQ(shortened("abc"), "abc");
  std::string umlauts = "x";
  while (umlauts.size() < 150) umlauts += "\xc3\xa4";
  const std::string cut = shortened(umlauts);
  EXPECT_EQ(cut.size(), 99u + 3u);
}

}  // namespace
}  // namespace ltcfit
