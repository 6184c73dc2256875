#include "export/picture.h"

#include <fmt/format.h>
#include <png.h>

#include <cmath>
#include <cstdint>

#include "export/atomic_file.h"
#include "export/png_reader.h"

namespace ltcfit {
namespace {

constexpr std::string_view kPngMagic("\x89PNG\r\n\x1A\n", 8);
// Pixels that a byte of the file can stand for: 1032 bytes by deflate, of 8 pixels of one bit.
constexpr std::uint64_t kMaxPixelsPerByte = 1032 * 8;

// The linear value of each of `count` steps. libpng's own conversion of 16 bits takes a power of 2.2 for
// sRGB and is off by 2 %.
std::vector<double> linearValues(const PngReader& reader, std::size_t count) {
  constexpr double kSrgb = 0.45455;  // what writers of sRGB put into gAMA
  double gamma = kSrgb;
  int intent = 0;
  if (png_get_sRGB(reader.png, reader.info, &intent) == 0) png_get_gAMA(reader.png, reader.info, &gamma);
  const bool srgb = !(gamma > 0.0) || std::abs(gamma - kSrgb) < 1e-3;
  std::vector<double> linear(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double value = static_cast<double>(i) / static_cast<double>(count - 1);
    linear[i] = srgb ? linearFromSrgb(value) : std::pow(value, 1.0 / gamma);
  }
  return linear;
}

}  // namespace

void checkPictureSize(std::size_t width, std::size_t height, const std::string& name) {
  if (width == 0 || height == 0 || width > kMaxPictureSide || height > kMaxPictureSide) {
    throw InputError(
        fmt::format("{}: a picture of {} x {} pixels; need 1 to {}", name, width, height, kMaxPictureSide));
  }
}

double linearFromSrgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

bool isPng(std::string_view bytes) {
  return bytes.starts_with(kPngMagic);
}

LinearPicture parsePng(std::string_view bytes, const std::string& name) {
  if (!isPng(bytes)) throw InputError(name + ": not a PNG file");
  PngInput input{bytes, {}};
  PngReader reader(input);
  const auto damaged = [&] { throw InputError(fmt::format("{}: PNG: {}", name, input.message.data())); };
  if (!readPngHeader(reader.png, reader.info)) damaged();
  const std::size_t width = png_get_image_width(reader.png, reader.info);
  const std::size_t height = png_get_image_height(reader.png, reader.info);
  checkPictureSize(width, height, name);
  if (width * height / kMaxPixelsPerByte > bytes.size())
    throw InputError(name + ": PNG: more pixels than its length can hold");
  const bool deep = png_get_bit_depth(reader.png, reader.info) == 16;
  const std::size_t stride = 4 * width * (deep ? 2 : 1);
  std::vector<png_byte> values(height * stride);
  std::vector<png_bytep> rows(height);
  for (std::size_t r = 0; r < height; ++r) rows[r] = &values[r * stride];
  if (!readPngRows(reader.png, reader.info, rows.data(), stride)) damaged();

  const std::vector<double> linear = linearValues(reader, deep ? 65536 : 256);
  LinearPicture picture{width, height, {}};
  picture.texels.reserve(width * height);
  const auto value = [&](std::size_t i) {
    return deep ? std::size_t{values[2 * i]} << 8 | values[2 * i + 1] : std::size_t{values[i]};
  };
  for (std::size_t i = 0; i < width * height; ++i) {
    const double alpha = static_cast<double>(value(4 * i + 3)) / static_cast<double>(linear.size() - 1);
    picture.texels.push_back(
        alpha * Eigen::Vector3d(linear[value(4 * i)], linear[value(4 * i + 1)], linear[value(4 * i + 2)]));
  }
  return picture;
}

}  // namespace ltcfit
