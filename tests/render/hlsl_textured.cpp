// ltc_textured.hlsl as C++. Built with -fsingle-precision-constant, since there 1.0 is a float.
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "tests/render/textured_shader.h"

namespace {

using glm::abs, glm::clamp, glm::cross, glm::max, glm::min, glm::sqrt, glm::log2;
using ltcfit::test::Vec3;
using float2 = glm::vec2;
using float3 = glm::vec3;

// fused, as GPUs may
float dot(float3 a, float3 b) {
  return std::fma(a.x, b.x, std::fma(a.y, b.y, a.z * b.z));
}

struct float3x3 {
  std::array<float3, 3> rows;
  float3 operator[](std::size_t i) const { return rows[i]; }
};
float3x3 operator*(const float3x3& m, float s) {
  return {{m[0] * s, m[1] * s, m[2] * s}};
}
float3 mul(const float3x3& m, float3 v) {
  return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

struct SamplerState {};
struct Colour {
  float3 rgb;
};
struct Texture2D {
  const ltcfit::test::MipMaps* levels;
  Colour SampleLevel(SamplerState, float2 at, float lod) const {
    const auto t = ltcfit::test::sampleTrilinear(*levels, at.x, at.y, lod);
    return {{t[0], t[1], t[2]}};
  }
};

#include "render/shaders/ltc_textured.hlsl"

float3 from(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

constinit const ltcfit::test::TexturedShader ltcfit::test::kTexturedHlsl{
    "hlsl",
    [](const Mat3& m, const std::array<Vec3, 4>& v, const MipMaps& picture, float margin,
       float lodScale) -> Vec3 {
      const float3 colour = ltcLightColour({{from(m[0]), from(m[1]), from(m[2])}}, from(v[0]), from(v[1]),
                                           from(v[2]), from(v[3]), {&picture}, {}, margin, lodScale);
      return {colour.x, colour.y, colour.z};
    }};
