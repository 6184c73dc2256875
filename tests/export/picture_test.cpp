// Pictures of every kind that PNG knows, written by libpng's other interface, and what they hold as linear
// values; damaged ones.
#include "export/picture.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "export/atomic_file.h"
#include "export/exr.h"

namespace ltcfit {
namespace {

using Eigen::Vector3d;

// 128 of 255 by the piecewise definition, and 51 of 255 (0.2) likewise, to 6 digits from tables.
constexpr double kLinear128 = 0.215861;
constexpr double kLinear51 = 0.033105;

struct Png {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  int depth = 8;
  int colours = PNG_COLOR_TYPE_RGB;
  std::vector<std::uint8_t> rows;  // as in the file
  std::vector<png_color> palette;
  bool linear = false;  // says so in gAMA
  bool interlaced = false;
};

std::string bytesOf(const Png& png) {
  std::string out;
  png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(writer);
  png_set_write_fn(
      writer, &out,
      [](png_structp w, png_bytep data, std::size_t size) {
        static_cast<std::string*>(png_get_io_ptr(w))->append(reinterpret_cast<char*>(data), size);
      },
      [](png_structp) {});
  png_set_IHDR(writer, info, png.width, png.height, png.depth, png.colours,
               png.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (!png.palette.empty())
    png_set_PLTE(writer, info, png.palette.data(), static_cast<int>(png.palette.size()));
  if (png.linear) png_set_gAMA(writer, info, 1.0);
  std::vector<png_bytep> rows;
  const std::size_t stride = png.rows.size() / png.height;
  for (std::size_t r = 0; r < png.height; ++r) rows.push_back(const_cast<png_bytep>(&png.rows[r * stride]));
  png_set_rows(writer, info, rows.data());
  png_write_png(writer, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&writer, &info);
  return out;
}

LinearPicture read(const Png& png) {
  return parsePng(bytesOf(png), "P");
}

void expectNear(const Vector3d& found, const Vector3d& expected, double tolerance) {
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance)
      << found.transpose() << ", not " << expected.transpose();
}

TEST(Picture, EightBitsAreSrgb) {
  const LinearPicture picture = read({2, 1, 8, PNG_COLOR_TYPE_RGB, {255, 128, 0, 51, 51, 128}, {}});
  ASSERT_EQ(picture.width, 2u);
  ASSERT_EQ(picture.height, 1u);
  expectNear(picture.texels[0], {1.0, kLinear128, 0.0}, 1e-6);  // the digits of the table
  expectNear(picture.texels[1], {kLinear51, kLinear51, kLinear128}, 1e-6);
}

TEST(Picture, AlphaIsMultipliedIn) {
  const LinearPicture rgba = read({1, 1, 8, PNG_COLOR_TYPE_RGBA, {255, 128, 0, 51}, {}});
  expectNear(rgba.texels[0], {0.2, 0.2 * kLinear128, 0.0}, 1e-6);
  const LinearPicture grey = read({1, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {128, 51}, {}});
  expectNear(grey.texels[0], Vector3d::Constant(0.2 * kLinear128), 1e-6);
}

TEST(Picture, GreyPaletteAndFewBits) {
  expectNear(read({1, 1, 8, PNG_COLOR_TYPE_GRAY, {128}, {}}).texels[0], Vector3d::Constant(kLinear128), 1e-6);
  // two pixels of 4 bits, 0 and 15
  const LinearPicture few = read({2, 1, 4, PNG_COLOR_TYPE_GRAY, {0x0F}, {}});
  expectNear(few.texels[0], Vector3d::Zero(), 0.0);
  expectNear(few.texels[1], Vector3d::Ones(), 0.0);
  const LinearPicture palette = read({2, 1, 8, PNG_COLOR_TYPE_PALETTE, {1, 0}, {{255, 0, 0}, {0, 128, 51}}});
  expectNear(palette.texels[0], {0.0, kLinear128, kLinear51}, 1e-6);
  expectNear(palette.texels[1], {1.0, 0.0, 0.0}, 0.0);
}

TEST(Picture, SixteenBits) {
  Png png{1, 1, 16, PNG_COLOR_TYPE_RGB, {0x80, 0x80, 0x33, 0x33, 0xFF, 0xFF}, {}};
  expectNear(read(png).texels[0], {kLinear128, kLinear51, 1.0}, 1e-6);
  png.linear = true;
  expectNear(read(png).texels[0], {0x8080 / 65535.0, 0.2, 1.0}, 1e-12);
}

TEST(Picture, RowsFromTheTopInterlacedOrNot) {
  Png png{3, 5, 8, PNG_COLOR_TYPE_GRAY, {}, {}};
  for (std::uint8_t i = 0; i < 15; ++i) png.rows.push_back(static_cast<std::uint8_t>(17 * i));
  for (const bool interlaced : {false, true}) {
    png.interlaced = interlaced;
    const LinearPicture picture = read(png);
    for (std::size_t i = 0; i < 15; ++i)
      EXPECT_DOUBLE_EQ(picture.texels[i].x(), linearFromSrgb(static_cast<double>(i) * 17.0 / 255.0)) << i;
  }
}

TEST(Picture, DamagedPngIsRefused) {
  Png png{16, 16, 8, PNG_COLOR_TYPE_RGB, {}, {}};
  for (int i = 0; i < 16 * 16 * 3; ++i) png.rows.push_back(static_cast<std::uint8_t>(i * i));
  const std::string good = bytesOf(png);
  ASSERT_NO_THROW(parsePng(good, "P"));
  // the end chunk of 12 bytes holds nothing
  for (std::size_t n = 0; n + 12 < good.size(); ++n)
    EXPECT_THROW(parsePng(std::string_view(good).substr(0, n), "P"), InputError) << n;
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string bytes = good;
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
      try {
        parsePng(bytes, "P");
      } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).rfind("P: ", 0), 0u) << error.what();
      }
    }
  }
}

TEST(Picture, ClaimsOfSizeAreChecked) {
  // an IHDR of its own, with the CRC that belongs to it
  const auto claiming = [](std::uint32_t width, std::uint32_t height) {
    std::string bytes = bytesOf({1, 1, 8, PNG_COLOR_TYPE_GRAY, {0}, {}});
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[16 + i] = static_cast<char>(width >> (24 - 8 * i));
      bytes[20 + i] = static_cast<char>(height >> (24 - 8 * i));
    }
    std::uint32_t crc = ~0u;
    for (std::size_t i = 12; i < 29; ++i) {
      crc ^= static_cast<std::uint8_t>(bytes[i]);
      for (int k = 0; k < 8; ++k) crc = (crc & 1u) != 0 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
    }
    for (std::size_t i = 0; i < 4; ++i) bytes[29 + i] = static_cast<char>(~crc >> (24 - 8 * i));
    return bytes;
  };
  EXPECT_NO_THROW(parsePng(claiming(1, 1), "P"));
  const auto message = [&](std::uint32_t width, std::uint32_t height) {
    try {
      parsePng(claiming(width, height), "P");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(message(8193, 1).find("8193 x 1"), std::string::npos) << message(8193, 1);
  EXPECT_NE(message(8192, 8192).find("more pixels"), std::string::npos) << message(8192, 8192);
}

}  // namespace
}  // namespace ltcfit
