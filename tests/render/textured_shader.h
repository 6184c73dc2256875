// ltc_textured.glsl and .hlsl, compiled as C++ as shader.h does with the others.
#pragma once

#include <array>
#include <cmath>
#include <ostream>
#include <vector>

#include "tests/render/shader.h"
#include "tests/render/texture.h"

namespace ltcfit::test {

using MipMaps = std::vector<Texture>;

/// As a sampler reads it: trilinear, in float32. A lod that is NaN aborts by std::vector::at.
inline std::array<float, 4> sampleTrilinear(const MipMaps& levels, float u, float v, float lod) {
  const float last = static_cast<float>(levels.size() - 1);
  if (std::isnan(lod)) return levels.at(levels.size()).texels.at(0);
  const float clamped = std::clamp(lod, 0.0f, last);
  const float low = std::floor(clamped);
  const float high = std::min(low + 1.0f, last);
  const std::array<float, 4> a = sampleLinear(levels.at(static_cast<std::size_t>(low)), u, v, 0.5f);
  const std::array<float, 4> b = sampleLinear(levels.at(static_cast<std::size_t>(high)), u, v, 0.5f);
  std::array<float, 4> out{};
  for (std::size_t c = 0; c < 4; ++c) out[c] = a[c] + (clamped - low) * (b[c] - a[c]);
  return out;
}

struct TexturedShader {
  const char* name;
  Vec3 (*lightColour)(const Mat3& inverse, const std::array<Vec3, 4>& vertices, const MipMaps& picture,
                      float margin, float lodScale);
};

inline std::ostream& operator<<(std::ostream& out, const TexturedShader& shader) {
  return out << shader.name;
}

extern const TexturedShader kTexturedGlsl;
extern const TexturedShader kTexturedHlsl;

}  // namespace ltcfit::test
