// Small pictures as PNG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace ltcfit {

/// Red, green and blue of each pixel, sRGB, row by row from the top.
struct Picture {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 width height
};

/// The bytes of the PNG file. Throws std::runtime_error where libpng fails.
std::string toPng(const Picture& picture);

/// RFC 4648, padded.
std::string toBase64(const std::string& bytes);

}  // namespace ltcfit
