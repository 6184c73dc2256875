// Texels as a texture file holds them, between the packings (what the numbers mean) and the containers.
#pragma once

#include <cstddef>
#include <vector>

namespace ltcfit {

enum class Precision { kFloat, kHalf };

/// Numbers in one texture that is read, at most: four times as many as the largest texture of a 64^4 table
/// has, and a picture of 8192 x 8192 texels of four. Readers refuse what claims more before they allocate
/// anything for it.
inline constexpr std::size_t kMaxImageNumbers = std::size_t{1} << 28;

/// One texture: 2D (depth 1), a 2D array (depth 1, layers > 1) or a volume (layers 1).
struct Image {
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t depth = 1;
  std::size_t layers = 1;
  std::size_t components = 4;  ///< numbers of one texel
  Precision precision = Precision::kFloat;
  std::vector<float> values;  ///< layer, z, y, x, component: the last fastest. Exact halves for kHalf

  std::size_t texels() const { return width * height * depth * layers; }
  std::size_t bytesPerValue() const { return precision == Precision::kHalf ? 2 : 4; }
};

}  // namespace ltcfit
