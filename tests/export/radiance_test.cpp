// Pictures of Radiance, made by hand.
#include "export/radiance.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Eigen::Vector3d;

std::string hdr(const std::string& resolution, const Bytes& pixels, const std::string& more = "") {
  return "#?RADIANCE\n# by hand\nFORMAT=32-bit_rle_rgbe\n" + more + "\n" + resolution + "\n" +
         std::string(pixels.begin(), pixels.end());
}

std::string messageOf(const std::string& bytes) {
  try {
    parseRadiance(bytes, "P");
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

// Values of the format's definition: mantissa / 256 times 2^(exponent - 128).
TEST(Radiance, KnownValues) {
  const LinearPicture picture = parseRadiance(
      hdr("-Y 1 +X 4", {128, 64, 32, 129, 255, 1, 0, 136, 200, 100, 50, 0, 128, 128, 128, 100}), "P");
  ASSERT_EQ(picture.width, 4u);
  ASSERT_EQ(picture.height, 1u);
  EXPECT_EQ(picture.texels[0], Vector3d(1.0, 0.5, 0.25));
  EXPECT_EQ(picture.texels[1], Vector3d(255.0, 1.0, 0.0));
  EXPECT_EQ(picture.texels[2], Vector3d(0.0, 0.0, 0.0));  // exponent 0 is black
  EXPECT_EQ(picture.texels[3], Vector3d::Constant(0x1p-29));
}

TEST(Radiance, ExposureIsDividedOut) {
  const LinearPicture picture =
      parseRadiance(hdr("-Y 1 +X 1", {128, 64, 32, 129}, "EXPOSURE= 4\nGAMMA=1\nEXPOSURE=0.5\n"), "P");
  EXPECT_EQ(picture.texels[0], Vector3d(0.5, 0.25, 0.125));
  for (const char* const bad : {"EXPOSURE=0\n", "EXPOSURE=-1\n", "EXPOSURE=nan\n", "EXPOSURE=\n",
                                "EXPOSURE=1x\n", "EXPOSURE=1e300\nEXPOSURE=1e300\n"})
    EXPECT_NE(messageOf(hdr("-Y 1 +X 1", {1, 2, 3, 4}, bad)).find("EXPOSURE"), std::string::npos) << bad;
}

// Pixel (x, y) from the top left is (16 x + y + 2, 0, 0) 2^-8, in a picture of 9 x 3.
Bytes pixelAt(std::size_t x, std::size_t y) {
  return {static_cast<std::uint8_t>(16 * x + y + 2), 0, 0, 128};
}

void append(Bytes& out, const Bytes& more) {
  out.insert(out.end(), more.begin(), more.end());
}

// The scanlines of an orientation, each as its pixels.
std::vector<std::vector<Bytes>> scanlines(bool slowIsY, bool up, bool left) {
  const std::size_t slow = slowIsY ? 3 : 9;
  const std::size_t fast = slowIsY ? 9 : 3;
  std::vector<std::vector<Bytes>> out(slow);
  for (std::size_t s = 0; s < slow; ++s) {
    for (std::size_t f = 0; f < fast; ++f) {
      const std::size_t x = slowIsY ? f : s;
      const std::size_t y = slowIsY ? s : f;
      out[s].push_back(pixelAt(left ? 8 - x : x, up ? 2 - y : y));
    }
  }
  return out;
}

TEST(Radiance, AllOrientationsAndEncodings) {
  for (const bool slowIsY : {true, false}) {
    for (const bool up : {false, true}) {
      for (const bool left : {false, true}) {
        const std::string y = fmt::format("{}Y 3", up ? '+' : '-');
        const std::string x = fmt::format("{}X 9", left ? '-' : '+');
        const std::string resolution = slowIsY ? y + " " + x : x + " " + y;
        Bytes flat;
        Bytes rle;
        for (const std::vector<Bytes>& line : scanlines(slowIsY, up, left)) {
          for (const Bytes& pixel : line) append(flat, pixel);
          const auto n = static_cast<std::uint8_t>(line.size());
          append(rle, {2, 2, 0, n});
          for (std::size_t c = 0; c < 4; ++c) {
            if (c == 0) {
              rle.push_back(n);
              for (const Bytes& pixel : line) rle.push_back(pixel[0]);
            } else {
              append(rle, {static_cast<std::uint8_t>(128 + n - 1), line[0][c], 1, line[0][c]});
            }
          }
        }
        std::vector<Bytes> encodings{flat};
        if (slowIsY) encodings.push_back(rle);  // a scanline of three pixels cannot be
        for (const Bytes& pixels : encodings) {
          const LinearPicture picture = parseRadiance(hdr(resolution, pixels), "P");
          ASSERT_EQ(picture.width, 9u);
          ASSERT_EQ(picture.height, 3u);
          for (std::size_t i = 0; i < 27; ++i)
            EXPECT_EQ(picture.texels[i].x(),
                      (16.0 * static_cast<double>(i % 9) + static_cast<double>(i / 9) + 2.0) / 256.0)
                << resolution << " " << i;
        }
      }
    }
  }
}

TEST(Radiance, OldRuns) {
  // 1 + 2 + 256 + 1 pixels: a run of 2, lengthened by one of 1 << 8
  const LinearPicture picture =
      parseRadiance(hdr("-Y 1 +X 260", {64, 0, 0, 129, 1, 1, 1, 2, 1, 1, 1, 1, 128, 0, 0, 129}), "P");
  for (std::size_t i = 0; i < 259; ++i) ASSERT_EQ(picture.texels[i].x(), 0.5) << i;
  EXPECT_EQ(picture.texels[259].x(), 1.0);
  EXPECT_NE(messageOf(hdr("-Y 1 +X 3", {1, 1, 1, 3, 0, 0, 0, 0})).find("scanline 0: a run of a wrong length"),
            std::string::npos);
  EXPECT_NE(messageOf(hdr("-Y 1 +X 3", {9, 9, 9, 9, 1, 1, 1, 3})).find("wrong length"), std::string::npos);
}

TEST(Radiance, WhatIsDamagedIsRefused) {
  const Bytes line{2, 2, 0, 8, 136, 7, 8, 1, 2, 3, 4, 5, 6, 7, 8, 130, 5, 134, 6, 136, 129};
  Bytes two = line;
  append(two, line);
  const Bytes runs{3, 4, 5, 129, 1, 1, 1, 7};
  for (const std::string& good : {hdr("-Y 2 +X 8", two, "EXPOSURE=2\n"), hdr("+X 1 -Y 8", runs)}) {
    ASSERT_EQ(messageOf(good), "accepted");
    for (std::size_t n = 0; n < good.size(); ++n) EXPECT_NE(messageOf(good.substr(0, n)), "accepted") << n;
    for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
      std::string flipped = good;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
      const std::string message = messageOf(flipped);
      EXPECT_TRUE(message == "accepted" || message.starts_with("P: ")) << message;
    }
  }
  Bytes wrong = two;
  wrong[3] = 9;
  EXPECT_NE(messageOf(hdr("-Y 2 +X 8", wrong)).find("scanline 0: is of another length"), std::string::npos);
  wrong = two;
  wrong[4] = 137;
  EXPECT_NE(messageOf(hdr("-Y 2 +X 8", wrong)).find("scanline 0: a run of a wrong length"),
            std::string::npos);
  EXPECT_NE(messageOf(hdr("-Y 2 +X 8", {two.begin(), two.end() - 1})).find("scanline 1: cut off"),
            std::string::npos);
}

TEST(Radiance, HeadersThatMislead) {
  const Bytes pixel{1, 2, 3, 4};
  for (const auto& [resolution, part] :
       std::initializer_list<std::pair<const char*, const char*>>{{"-Y 8193 +X 1", "8193"},
                                                                  {"-Y 0 +X 1", "1 x 0"},
                                                                  {"-Y 8192 +X 8192", "more pixels"},
                                                                  {"-Y 99999999999999999999 +X 1", "no size"},
                                                                  {"-Y 1 -Y 1", "no size"},
                                                                  {"-Y 1", "no size"},
                                                                  {"-Z 1 +X 1", "no size"},
                                                                  {"-Y 1 +X 1 3", "no size"},
                                                                  {"-Y -1 +X 1", "no size"},
                                                                  {"", "no size"},
                                                                  {"+", "no size"}})
    EXPECT_NE(messageOf(hdr(resolution, pixel)).find(part), std::string::npos) << resolution;
  EXPECT_NE(messageOf("#?RADIANCE\n\n-Y 1 +X 1\nabcd").find("no FORMAT"), std::string::npos);
  EXPECT_NE(messageOf("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd").find("xyze' is not read"),
            std::string::npos);
  EXPECT_NE(messageOf("#?RGBE\n" + std::string(1 << 20, 'x')).find("header"), std::string::npos);
  std::string lines = "#?RGBE\n";
  for (int i = 0; i < 100000; ++i) lines += "a=b\n";
  EXPECT_NE(messageOf(lines).find("64 KiB"), std::string::npos);
  EXPECT_NE(messageOf("P6\n").find("not a picture"), std::string::npos);
}

}  // namespace
}  // namespace ltcfit
