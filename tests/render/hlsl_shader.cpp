// ltc.hlsl as C++. Built with -fsingle-precision-constant, since there 1.0 is a float.
#include <cmath>
#include <glm/glm.hpp>

#include "tests/render/shader.h"

namespace {

using glm::abs, glm::clamp, glm::floor, glm::max, glm::min, glm::normalize, glm::sqrt;
using ltcfit::test::Texture;
using float2 = glm::vec2;
using float3 = glm::vec3;
using float4 = glm::vec4;
using int2 = glm::ivec2;

float dot(float3 a, float3 b) {
  return std::fma(a.x, b.x, std::fma(a.y, b.y, a.z * b.z));
}
float3 cross(float3 a, float3 b) {
  return {std::fma(a.y, b.z, -(a.z * b.y)), std::fma(a.z, b.x, -(a.x * b.z)),
          std::fma(a.x, b.y, -(a.y * b.x))};
}
float length(float2 v) {
  return std::sqrt(std::fma(v.x, v.x, v.y * v.y));
}
float rsqrt(float x) {
  return 1.0f / std::sqrt(x);
}
float atan2(float y, float x) {
  return std::atan2(y, x);
}
float saturate(float x) {
  return glm::clamp(x, 0.0f, 1.0f);
}
template <class T>
T lerp(T a, T b, float t) {
  return a + (b - a) * t;  // as HLSL defines it: at t = 1 not always b
}

struct float3x3 {
  float3 row0, row1, row2;
  float3x3() = default;
  float3x3(float3 r0, float3 r1, float3 r2) : row0(r0), row1(r1), row2(r2) {}
};
float3 mul(float3x3 m, float3 v) {
  return {dot(m.row0, v), dot(m.row1, v), dot(m.row2, v)};
}
float3x3 transpose(float3x3 m) {
  return {{m.row0.x, m.row1.x, m.row2.x}, {m.row0.y, m.row1.y, m.row2.y}, {m.row0.z, m.row1.z, m.row2.z}};
}

struct SamplerState {};
struct Texture2D {
  const Texture* texture;
  void GetDimensions(float& width, float& height) const {
    width = static_cast<float>(texture->width);
    height = static_cast<float>(texture->height);
  }
  float4 SampleLevel(SamplerState, float2 at, float) const {
    const auto t = sampleLinear(*texture, at.x, at.y, 0.5f);
    return {t[0], t[1], t[2], t[3]};
  }
};
struct Texture3D {
  const Texture* texture;
  void GetDimensions(float& width, float& height, float& depth) const {
    width = static_cast<float>(texture->width);
    height = static_cast<float>(texture->height);
    depth = static_cast<float>(texture->depth);
  }
  float4 SampleLevel(SamplerState, float3 at, float) const {
    const auto t = sampleLinear(*texture, at.x, at.y, at.z);
    return {t[0], t[1], t[2], t[3]};
  }
};

#include "render/shaders/ltc.hlsl"
#include "render/shaders/ltc_proxy.hlsl"

using ltcfit::test::Mat3;
using ltcfit::test::ShaderEntry;
using ltcfit::test::Vec3;

// behind what it takes LtcEntry from
#include "data/ltc_iso.cheb.hlsl"

float3 from(const Vec3& v) {
  return {v[0], v[1], v[2]};
}
Vec3 to(float3 v) {
  return {v.x, v.y, v.z};
}
float3x3 from(const Mat3& m) {
  return {from(m[0]), from(m[1]), from(m[2])};
}
Mat3 to(const float3x3& m) {
  return {to(m.row0), to(m.row1), to(m.row2)};
}
ShaderEntry to(const LtcEntry& e) {
  return {to(e.inverse), e.norm, e.fresnel};
}

#include "lookups_hlsl.inc"

}  // namespace

constinit const ltcfit::test::Shader ltcfit::test::kHlsl{
    "hlsl",
    [](const Texture& matrix, const Texture& amplitude, float roughness, float nDotV) {
      return to(ltcFetch({&matrix}, {&amplitude}, {}, roughness, nDotV));
    },
    [](const Texture& table, int nAlpha, int nLambda, float alphaX, float alphaY, Vec3 view) {
      return to(ltcFetchAnisotropic({&table}, {}, int2(nAlpha, nLambda), alphaX, alphaY, from(view)));
    },
    [](Vec3 n, Vec3 v) { return to(ltcFrame(from(n), from(v))); },
    [](const Mat3& inverse, const std::array<Vec3, 4>& v) {
      return ltcQuad(from(inverse), from(v[0]), from(v[1]), from(v[2]), from(v[3]));
    },
    [](const Mat3& inverse, const std::vector<Vec3>& vertices) {
      float3 v[LTC_MAX_VERTICES];
      for (std::size_t i = 0; i < vertices.size(); ++i) v[i] = from(vertices[i]);
      return ltcPolygon(from(inverse), v, static_cast<int>(vertices.size()));
    },
    [](const Mat3& inverse, const std::array<Vec3, 4>& v) {
      return to(ltcVectorFormFactor(from(inverse), from(v[0]), from(v[1]), from(v[2]), from(v[3])));
    },
    [](Vec3 f) { return ltcProxySphere(from(f)); },
    [](const Texture& table, Vec3 f) { return ltcProxySphereTable({&table}, {}, from(f)); },
    [](Vec3 v0, Vec3 v1, Vec3 v2) { return ltcFacing(from(v0), from(v1), from(v2)); },
    [](const std::array<Vec3, 4>& v) {
      return ltcAboveSurface(from(v[0]), from(v[1]), from(v[2]), from(v[3]));
    },
    ltcArc,
    [](const ShaderEntry& e, Vec3 f0, Vec3 f90) {
      return to(ltcFresnel({from(e.inverse), e.norm, e.fresnel}, from(f0), from(f90)));
    },
    kLookups,
    [](float roughness, float nDotV) { return to(ltc_iso_fetch(roughness, nDotV)); },
    [](const std::vector<std::array<float, 4>>& shape, const std::vector<std::array<float, 2>>& amplitude,
       float roughness, float nDotV) {
      float4 s[ltc_iso_rows];
      float2 a[ltc_iso_rows];
      for (std::size_t j = 0; j < ltc_iso_rows; ++j) {
        s[j] = {shape[j][0], shape[j][1], shape[j][2], shape[j][3]};
        a[j] = {amplitude[j][0], amplitude[j][1]};
      }
      return to(ltc_iso_fetchCollapsed(s, a, roughness, nDotV));
    },
    ltc_iso_rows};
