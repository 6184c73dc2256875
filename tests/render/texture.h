// A texture as a sampler reads it: linear filtering, clamped to the edge, in float32.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace ltcfit::test {

/// depth = 1 for a 2D texture. Texel (x, y, z) at texels[(z * height + y) * width + x]; channels that it has
/// not are 0.
struct Texture {
  int width = 0;
  int height = 0;
  int depth = 1;
  std::vector<std::array<float, 4>> texels;
  /// Bits of the fraction between texels; 0 for all of float32. Direct3D asks for 8, and most units have
  /// them.
  int fractionBits = 0;
};

/// At normalised coordinates, texel centres at (i + 0.5) / n. NaN coordinates abort by std::vector::at.
inline std::array<float, 4> sampleLinear(const Texture& texture, float u, float v, float w) {
  struct Position {
    std::size_t low, high;
    float fraction;
  };
  const auto position = [&](float coordinate, int size) {
    float t = coordinate * static_cast<float>(size) - 0.5f;
    if (texture.fractionBits > 0) {
      const auto steps = static_cast<float>(1 << texture.fractionBits);
      t = std::round(t * steps) / steps;
    }
    const float low = std::floor(t);
    const auto texel = [&](float i) {
      return std::isnan(i) ? texture.texels.size()
                           : static_cast<std::size_t>(std::clamp(i, 0.0f, static_cast<float>(size - 1)));
    };
    return Position{texel(low), texel(low + 1.0f), t - low};
  };
  const Position x = position(u, texture.width);
  const Position y = position(v, texture.height);
  const Position z = position(w, texture.depth);
  std::array<float, 4> sum{};
  for (unsigned corner = 0; corner < 8; ++corner) {
    const auto weight = [&](unsigned bit, float f) { return (corner & bit) != 0 ? f : 1.0f - f; };
    const auto texel = [&](unsigned bit, const Position& p) { return (corner & bit) != 0 ? p.high : p.low; };
    const float factor = weight(1, x.fraction) * weight(2, y.fraction) * weight(4, z.fraction);
    const std::size_t index = (texel(4, z) * static_cast<std::size_t>(texture.height) + texel(2, y)) *
                                  static_cast<std::size_t>(texture.width) +
                              texel(1, x);
    for (std::size_t c = 0; c < 4; ++c) sum[c] += factor * texture.texels.at(index)[c];
  }
  return sum;
}

}  // namespace ltcfit::test
