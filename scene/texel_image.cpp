#include "scene/texel_image.h"

#include <fmt/format.h>
#include <stb_image.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "export/atomic_file.h"
#include "export/picture.h"

namespace ltcfit {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kJpegStart = "\xff\xd8\xff"sv;

std::size_t bigEndian32(std::string_view bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

// The most texels that so many bytes can be, by the formats' own best compression: what a header says beyond
// that is not there, and would be decoded as padding for minutes.
double mostTexels(std::string_view bytes) {
  const double length = static_cast<double>(bytes.size());
  // 8 x 8 coefficients by one bit of a progressive scan, in each of up to two scans that a decoder can do
  // with
  constexpr double kJpegTexelsPerByte = 1024.0;
  if (!isPng(bytes)) return kJpegTexelsPerByte * length;
  // deflate's 1032 : 1, on texels of depth x channels bits
  constexpr double kDeflateRatio = 1032.0;
  const int depth = static_cast<unsigned char>(bytes[24]);
  const int colours = static_cast<unsigned char>(bytes[25]);
  const int channels = colours == 2 ? 3 : colours == 4 ? 2 : colours == 6 ? 4 : 1;
  return kDeflateRatio * length * 8.0 / std::max(1, depth * channels);
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
  if (!isPng(bytes) && !bytes.starts_with(kJpegStart))
    throw InputError(name + " is neither a PNG nor a JPEG");
  if (bytes.size() > std::size_t{std::numeric_limits<int>::max()})
    throw InputError(name + " is larger than 2 GiB");
  const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int length = static_cast<int>(bytes.size());
  int width = 0;
  int height = 0;
  int channels = 0;
  const auto refuse = [&](std::size_t w, std::size_t h) {
    if (w > kMaxTexelSide || h > kMaxTexelSide)
      throw InputError(fmt::format("{} has {} x {} texels; a side may have {}", name, w, h, kMaxTexelSide));
    if (w * h > maxTexels)
      throw InputError(fmt::format("{} has {} x {} texels: with it the scene's images have more than {}",
                                   name, w, h, kMaxTexels));
    if (static_cast<double>(w * h) > mostTexels(bytes))
      throw InputError(
          fmt::format("{} claims {} x {} texels, which its {} bytes cannot hold", name, w, h, bytes.size()));
  };
  if (isPng(bytes)) {
    constexpr std::size_t kHeaderEnd = 33;
    if (bytes.size() < kHeaderEnd || bytes.substr(12, 4) != "IHDR")
      throw InputError(name + " is damaged: no IHDR");
    // stb's own limit would answer without the numbers
    refuse(bigEndian32(bytes, 16), bigEndian32(bytes, 20));
  }
  if (stbi_info_from_memory(data, length, &width, &height, &channels) == 0 || width < 1 || height < 1)
    throw InputError(fmt::format("{} is damaged: {}", name, stbi_failure_reason()));
  refuse(static_cast<std::size_t>(width), static_cast<std::size_t>(height));
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(data, length, &width, &height, &channels, 4), &stbi_image_free);
  if (!pixels) throw InputError(fmt::format("{} is damaged: {}", name, stbi_failure_reason()));
  TexelImage image;
  image.width = static_cast<std::size_t>(width);
  image.height = static_cast<std::size_t>(height);
  image.texels.resize(image.width * image.height);
  std::memcpy(image.texels.data(), pixels.get(), 4 * image.texels.size());
  return image;
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
