#include "export/ktx2.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <stdexcept>

#include "export/atomic_file.h"
#include "export/little_endian.h"

namespace ltcfit {
namespace {

Ktx2File file(std::size_t depth, std::size_t layers, std::size_t components, Precision precision) {
  Ktx2File out;
  out.image.width = 5;
  out.image.height = 3;
  out.image.depth = depth;
  out.image.layers = layers;
  out.image.components = components;
  out.image.precision = precision;
  for (std::size_t i = 0; i < out.image.texels() * components; ++i)
    out.image.values.push_back(0.25f * static_cast<float>(i) - 1.0f);
  out.keyValues = {{"KTXwriter", "test"}, {"abc", "a longer value\nof two lines"}};
  return out;
}

TEST(Ktx2, WritesWhatItReads) {
  for (Ktx2Compression compression : {Ktx2Compression::kNone, Ktx2Compression::kZstd}) {
    for (Precision precision : {Precision::kFloat, Precision::kHalf}) {
      for (std::size_t components : {std::size_t{1}, std::size_t{2}, std::size_t{4}}) {
        for (const auto& [depth, layers] : {std::pair<std::size_t, std::size_t>{1, 1}, {4, 1}, {1, 3}}) {
          const Ktx2File written = file(depth, layers, components, precision);
          const Ktx2File back = parseKtx2(imageToKtx2(written, compression), "a");
          EXPECT_EQ(back.image.depth, depth);
          EXPECT_EQ(back.image.layers, layers);
          EXPECT_EQ(back.image.precision, precision);
          EXPECT_EQ(back.image.values, written.image.values);
          EXPECT_EQ(back.keyValues, written.keyValues);
        }
      }
    }
  }
}

// KTX 2.0, revision 4: what a validator looks at.
TEST(Ktx2, FollowsTheSpecification) {
  for (Ktx2Compression compression : {Ktx2Compression::kNone, Ktx2Compression::kZstd}) {
    Ktx2File unsorted = file(1, 2, 4, Precision::kHalf);
    std::swap(unsorted.keyValues[0], unsorted.keyValues[1]);
    const std::string bytes = imageToKtx2(unsorted, compression);
    const auto u32 = [&](std::size_t at) { return readAt<std::uint32_t>(bytes, at); };
    EXPECT_EQ(u32(12), 97u);  // VK_FORMAT_R16G16B16A16_SFLOAT
    EXPECT_EQ(u32(16), 2u);   // typeSize
    EXPECT_EQ(u32(20), 5u);
    EXPECT_EQ(u32(24), 3u);
    EXPECT_EQ(u32(28), 0u);  // depth: not a volume
    EXPECT_EQ(u32(32), 2u);  // layers
    EXPECT_EQ(u32(36), 1u);
    EXPECT_EQ(u32(40), 1u);
    EXPECT_EQ(u32(44), compression == Ktx2Compression::kZstd ? 2u : 0u);
    const std::size_t dfd = u32(48);
    EXPECT_EQ(dfd, 80u + 24u);  // right behind the level index
    EXPECT_EQ(u32(52), 4u + 24u + 4u * 16u);
    EXPECT_EQ(u32(dfd), u32(52));                    // total size
    EXPECT_EQ(u32(dfd + 4), 0u);                     // vendor, type
    EXPECT_EQ(u32(dfd + 8), 2u | 88u << 16);         // version, block size
    EXPECT_EQ(u32(dfd + 12), 0x00010101u);           // RGBSDA, BT.709, linear, straight alpha
    EXPECT_EQ(u32(dfd + 16), 0u);                    // texel block 1 x 1 x 1 x 1
    EXPECT_EQ(u32(dfd + 20), 8u);                    // bytes of plane 0
    const std::uint32_t channels[] = {0, 1, 2, 15};  // R, G, B, A
    for (std::uint32_t s = 0; s < 4; ++s) {
      EXPECT_EQ(u32(dfd + 28 + 16 * s), 16 * s | 15u << 16 | (0xC0u | channels[s]) << 24);
      EXPECT_EQ(u32(dfd + 36 + 16 * s), 0xBF800000u);
      EXPECT_EQ(u32(dfd + 40 + 16 * s), 0x3F800000u);
    }
    EXPECT_EQ(u32(56), dfd + u32(52));                                 // key/value data follow
    EXPECT_EQ(parseKtx2(bytes, "a").keyValues[0].first, "KTXwriter");  // sorted
    const auto level = readAt<std::uint64_t>(bytes, 80);
    EXPECT_GE(level, u32(56) + u32(60));
    EXPECT_EQ(level + readAt<std::uint64_t>(bytes, 88), bytes.size());
    EXPECT_EQ(readAt<std::uint64_t>(bytes, 96), 5u * 3u * 2u * 8u);
    if (compression == Ktx2Compression::kNone) {
      EXPECT_EQ(level % 8, 0u);
    }
  }
}

TEST(Ktx2, RefusesEverythingElse) {
  const std::string good = imageToKtx2(file(1, 2, 4, Precision::kHalf), Ktx2Compression::kZstd);
  const auto with = [&](std::size_t at, std::uint32_t v) {
    std::string bad = good;
    std::memcpy(bad.data() + at, &v, 4);
    return bad;
  };
  for (const auto& [at, value] : {std::pair<std::size_t, std::uint32_t>{12, 37},  // RGBA8
                                  {20, 0},
                                  {20, 0xFFFFFFFF},
                                  {20, 6},
                                  {32, 3},
                                  {36, 6},  // cube map
                                  {40, 9},  // levels
                                  {44, 1},  // BasisLZ
                                  {56, 0xFFFFFFF0},
                                  {60, 0xFFFFFFF0},
                                  {80, 0xFFFFFFF0},
                                  {84, 1},
                                  {96, 1 << 30}}) {
    EXPECT_THROW(parseKtx2(with(at, value), "a"), InputError) << at << " " << value;
  }
  EXPECT_THROW(imageToKtx2(file(2, 2, 4, Precision::kHalf), Ktx2Compression::kNone), std::invalid_argument);
  EXPECT_THROW(imageToKtx2(file(1, 1, 3, Precision::kHalf), Ktx2Compression::kNone), std::invalid_argument);
}

// Files whose length bears out what they claim, by the ratio of zstd alone: 64 MiB for 16 GiB.
TEST(Ktx2, ClaimsAreBoundedByWhatATableCanBe) {
  std::string bytes = imageToKtx2(file(1, 1, 4, Precision::kFloat), Ktx2Compression::kZstd);
  const auto claim = [&](std::uint32_t width, std::uint32_t height, std::uint32_t layers) {
    const std::array<std::uint32_t, 4> sides{width, height, 0, layers};
    std::memcpy(bytes.data() + 20, sides.data(), sizeof sides);
    const std::uint64_t size = std::uint64_t{width} * height * std::max(1u, layers) * 16;
    std::memcpy(bytes.data() + 96, &size, 8);
  };
  const auto expectRefused = [&](const std::string& what) {
    try {
      parseKtx2(bytes, "a");
      ADD_FAILURE() << "read, " << what;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  claim(16384, 16384, 4);
  expectRefused("16384 x 16384 x 1 texels, 4 layers of 4 numbers; need 268435456 numbers at most");
  // long enough for its claim, but the frame says 1 MiB: nothing is allocated to find out
  Image noise;
  noise.width = noise.height = 256;
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < 4 * noise.texels(); ++i) {
    state = 1664525 * state + 1013904223;
    noise.values.push_back(std::bit_cast<float>(0x3F800000u | state >> 9));
  }
  bytes = imageToKtx2({noise, {}}, Ktx2Compression::kZstd);
  claim(2048, 4096, 0);
  expectRefused("a zstd frame of 1048576 bytes where the KTX2 header claims 134217728");
}

}  // namespace
}  // namespace ltcfit
