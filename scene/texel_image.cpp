#include "scene/texel_image.h"

#include <fmt/format.h>

#include <cmath>

#include "export/atomic_file.h"
#include "export/jpeg_reader.h"
#include "export/picture.h"
#include "export/png_reader.h"

namespace ltcfit {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kJpegStart = "\xff\xd8\xff"sv;

void checkSize(std::size_t width, std::size_t height, double most, std::string_view bytes,
               const std::string& name, std::size_t maxTexels) {
  if (width > kMaxTexelSide || height > kMaxTexelSide)
    throw InputError(
        fmt::format("{} has {} x {} texels; a side may have {}", name, width, height, kMaxTexelSide));
  if (width * height > maxTexels)
    throw InputError(fmt::format("{} has {} x {} texels: with it the scene's images have more than {}", name,
                                 width, height, kMaxTexels));
  // what a header says beyond that is not there, and would be decoded as padding for minutes
  if (static_cast<double>(width * height) > most)
    throw InputError(fmt::format("{} claims {} x {} texels, which its {} bytes cannot hold", name, width,
                                 height, bytes.size()));
}

TexelImage imageOf(std::size_t width, std::size_t height) {
  TexelImage image;
  image.width = width;
  image.height = height;
  image.texels.resize(width * height);
  return image;
}

TexelImage decodePng(std::string_view bytes, const std::string& name, std::size_t maxTexels) {
  PngInput input{bytes, {}};
  PngReader reader(input);
  // libpng's own limits would answer without the numbers
  png_set_user_limits(reader.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  const auto damaged = [&] {
    throw InputError(fmt::format("{} is damaged: {}", name, input.message.data()));
  };
  if (!readPngHeader(reader.png, reader.info)) damaged();
  const std::size_t width = png_get_image_width(reader.png, reader.info);
  const std::size_t height = png_get_image_height(reader.png, reader.info);
  // deflate's 1032 : 1
  const int bits = png_get_bit_depth(reader.png, reader.info) * png_get_channels(reader.png, reader.info);
  const double most = 1032.0 * 8.0 * static_cast<double>(bytes.size()) / bits;
  checkSize(width, height, most, bytes, name, maxTexels);
  TexelImage image = imageOf(width, height);
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < height; ++y) rows.push_back(image.texels[y * width].data());
  if (!readPngRows(reader.png, reader.info, rows.data(), 4 * width, true)) damaged();
  return image;
}

TexelImage decodeJpeg(std::string_view bytes, const std::string& name, std::size_t maxTexels) {
  JpegReader reader(bytes);
  const auto damaged = [&] { throw InputError(fmt::format("{} is damaged: {}", name, reader.message())); };
  if (!reader.readHeader()) damaged();
  const double most = static_cast<double>(kJpegPixelsPerByte * bytes.size());
  checkSize(reader.width(), reader.height(), most, bytes, name, maxTexels);
  TexelImage image = imageOf(reader.width(), reader.height());
  if (!reader.readRows(image.texels[0].data())) damaged();
  return image;
}

double radicalInverse(unsigned base, unsigned n) {
  double value = 0.0;
  double digit = 1.0 / base;
  for (; n > 0; n /= base, digit /= base) value += digit * (n % base);
  return value;
}

}  // namespace

std::string unreadableKind(std::string_view bytes) {
  if (bytes.starts_with("\xabKTX 20\xbb")) return "KTX2";
  if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP")) return "WebP";
  if (bytes.size() >= 12 && bytes.substr(4, 7) == "ftypavi") return "AVIF";
  if (bytes.starts_with("DDS ")) return "DDS";
  return {};
}

TexelImage decodeTexels(std::string_view bytes, const std::string& name, std::size_t maxTexels) {
  if (isPng(bytes)) return decodePng(bytes, name, maxTexels);
  if (bytes.starts_with(kJpegStart)) return decodeJpeg(bytes, name, maxTexels);
  throw InputError(name + " is neither a PNG nor a JPEG");
}

TexelImage uniformTexels() {
  constexpr std::array<unsigned, 4> kBases{2, 3, 5, 7};
  TexelImage image;
  image.width = image.height = 64;
  image.texels.resize(image.width * image.height);
  for (unsigned n = 0; n < image.texels.size(); ++n)
    for (std::size_t c = 0; c < 4; ++c)
      image.texels[n][c] = static_cast<std::uint8_t>(std::lround(255.0 * radicalInverse(kBases[c], n)));
  return image;
}

double linearFromSrgb8(std::uint8_t value) {
  static const std::array<double, 256> kTable = [] {
    std::array<double, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = linearFromSrgb(static_cast<double>(i) / 255.0);
    return table;
  }();
  return kTable[value];
}

double luminance(const std::array<double, 3>& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

}  // namespace ltcfit
