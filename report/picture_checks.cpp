#include "report/picture_checks.h"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "export/atomic_file.h"
#include "export/picture.h"

namespace ltcfit {
namespace {

// 0..63, or -1.
int digitOf(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

std::string fromBase64(const std::string& text, const std::string& where) {
  const auto fail = [&](const char* what) { throw InputError(fmt::format("{} {}", where, what)); };
  if (text.empty() || text.size() % 4 != 0) fail("is not base64: its length is not a multiple of 4");
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  std::string out;
  out.reserve(text.size() / 4 * 3);
  std::uint32_t group = 0;
  for (std::size_t i = 0; i < text.size() - padding; ++i) {
    const int digit = digitOf(text[i]);
    if (digit < 0) fail("is not base64: a character that is not of its alphabet");
    group = group << 6 | static_cast<std::uint32_t>(digit);
    // the bits are in: of 6, 12, 18 and 24 the last three end a byte
    const std::size_t place = i % 4;
    if (place > 0) out += static_cast<char>(group >> (6 - 2 * place) & 255u);
  }
  return out;
}

std::uint32_t bigEndian32(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<std::uint8_t>(c);
  return value;
}

}  // namespace

void PictureChecks::require(const JsonFields& pictures, const char* key) {
  const std::string where = pictures.where(key);
  const std::string bytes = fromBase64(pictures.text(key), where);
  if (!isPng(bytes)) throw InputError(where + " is not a PNG");
  // the header is the first chunk; its size is asked before anything is decoded
  constexpr std::size_t kWidthAt = 16;
  constexpr std::size_t kHeightAt = 20;
  if (bytes.size() < kHeightAt + 4) throw InputError(where + " ends within its header");
  const std::size_t width = bigEndian32(std::string_view(bytes).substr(kWidthAt));
  const std::size_t height = bigEndian32(std::string_view(bytes).substr(kHeightAt));
  if (width > kMostPictureSide || height > kMostPictureSide)
    throw InputError(fmt::format("{} is {} x {} pixels, more than {} along a side", where, width, height,
                                 kMostPictureSide));
  pixels_ += width * height;
  if (pixels_ > kMostPicturePixels)
    throw InputError(
        fmt::format("{}: with it, the pictures have more than {} pixels", where, kMostPicturePixels));
  parsePng(bytes, where);
}

}  // namespace ltcfit
