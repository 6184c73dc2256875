#include "export/dds.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

std::string dds(std::uint32_t width, std::uint32_t height, std::size_t halves) {
  std::string out("DDS ", 4);
  out.resize(128, '\0');
  const auto put = [&](std::size_t at, std::uint32_t v) { std::memcpy(out.data() + at, &v, 4); };
  put(4, 124);
  put(12, height);
  put(16, width);
  put(84, 113);
  for (std::size_t i = 0; i < halves; ++i) out += std::string("\x00\x3C", 2);  // 1.0
  return out;
}

Image image(std::size_t depth, std::size_t layers, std::size_t components, Precision precision) {
  Image out;
  out.width = 3;
  out.height = 2;
  out.depth = depth;
  out.layers = layers;
  out.components = components;
  out.precision = precision;
  for (std::size_t i = 0; i < out.texels() * components; ++i)
    out.values.push_back(0.25f * static_cast<float>(i) - 1.0f);
  return out;
}

void expectSame(const Image& a, const Image& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.layers, b.layers);
  EXPECT_EQ(a.components, b.components);
  EXPECT_EQ(a.precision, b.precision);
  EXPECT_EQ(a.values, b.values);
}

TEST(Dds, Reads) {
  const Image a = parseDds(dds(3, 2, 24), "a.dds");
  EXPECT_EQ(a.width, 3u);
  EXPECT_EQ(a.height, 2u);
  EXPECT_EQ(a.values, std::vector<float>(24, 1.0f));
}

TEST(Dds, WritesWhatItReads) {
  for (Precision precision : {Precision::kFloat, Precision::kHalf}) {
    for (std::size_t components : {std::size_t{2}, std::size_t{4}}) {
      for (const auto& [depth, layers] : {std::pair<std::size_t, std::size_t>{1, 1}, {5, 1}, {1, 4}}) {
        const Image written = image(depth, layers, components, precision);
        expectSame(parseDds(imageToDds(written, DdsHeader::kDx10), "a"), written);
        if (layers == 1) expectSame(parseDds(imageToDds(written, DdsHeader::kLegacy), "a"), written);
      }
    }
  }
}

TEST(Dds, RefusesWhatAHeaderCannotSay) {
  EXPECT_THROW(imageToDds(image(1, 2, 4, Precision::kHalf), DdsHeader::kLegacy), std::invalid_argument);
  EXPECT_THROW(imageToDds(image(2, 2, 4, Precision::kHalf), DdsHeader::kDx10), std::invalid_argument);
  EXPECT_THROW(imageToDds(image(1, 1, 3, Precision::kFloat), DdsHeader::kDx10), std::invalid_argument);
}

TEST(Dds, RefusesEverythingElse) {
  const std::string good = dds(3, 2, 24);
  const auto with = [&](std::size_t at, std::uint32_t v) {
    std::string bad = good;
    std::memcpy(bad.data() + at, &v, 4);
    return bad;
  };
  EXPECT_THROW(parseDds(dds(0xFFFFFFFF, 0xFFFFFFFF, 24), "a"), InputError);
  EXPECT_THROW(parseDds(dds(0, 2, 0), "a"), InputError);
  EXPECT_THROW(parseDds(good + "x", "a"), InputError);
  EXPECT_THROW(parseDds(with(84, 'D'), "a"), InputError);
  EXPECT_THROW(parseDds(with(28, 7), "a"), InputError);        // mip maps
  EXPECT_THROW(parseDds(with(112, 0xFE00), "a"), InputError);  // cube map
  EXPECT_NO_THROW(parseDds(with(28, 1), "a"));
}

// The header that engines load today, byte for byte.
TEST(Dds, LegacyHeaderIsThatOfThePublishedTable) {
  const std::filesystem::path path = std::filesystem::path(LTCFIT_REFERENCE_DIR) / "ltc2017-1.dds";
  if (!std::filesystem::exists(path))
    GTEST_SKIP() << "the published tables are not at " << LTCFIT_REFERENCE_DIR;
  const std::string bytes = readFile(path);
  EXPECT_EQ(imageToDds(parseDds(bytes, "a"), DdsHeader::kLegacy), bytes);
}

}  // namespace
}  // namespace ltcfit
