// ltc.glsl as C++. Built with -fsingle-precision-constant, since there 1.0 is a float.
#include <glm/glm.hpp>

#include "tests/render/shader.h"

namespace {

using namespace glm;
using ltcfit::test::Texture;

struct Sampler {
  const Texture* texture;
};
struct sampler2D : Sampler {};
struct sampler3D : Sampler {};

ivec2 textureSize(sampler2D s, int) {
  return {s.texture->width, s.texture->height};
}
ivec3 textureSize(sampler3D s, int) {
  return {s.texture->width, s.texture->height, s.texture->depth};
}
vec4 toVec4(const std::array<float, 4>& a) {
  return {a[0], a[1], a[2], a[3]};
}
vec4 textureLod(sampler2D s, vec2 at, float) {
  return toVec4(sampleLinear(*s.texture, at.x, at.y, 0.5f));
}
vec4 textureLod(sampler3D s, vec3 at, float) {
  return toVec4(sampleLinear(*s.texture, at.x, at.y, at.z));
}

#include "render/shaders/ltc.glsl"
#include "render/shaders/ltc_proxy.glsl"

using ltcfit::test::Mat3;
using ltcfit::test::ShaderEntry;
using ltcfit::test::Vec3;

// behind what it takes LtcEntry from
#include "data/ltc_iso.cheb.glsl"

vec3 from(const Vec3& v) {
  return {v[0], v[1], v[2]};
}
Vec3 to(vec3 v) {
  return {v.x, v.y, v.z};
}
// GLSL's matrices are indexed by column
mat3 from(const Mat3& m) {
  return transpose(mat3(from(m[0]), from(m[1]), from(m[2])));
}
Mat3 to(const mat3& m) {
  const mat3 rows = transpose(m);
  return {to(rows[0]), to(rows[1]), to(rows[2])};
}
ShaderEntry to(const LtcEntry& e) {
  return {to(e.inverse), e.norm, e.fresnel};
}

#include "lookups_glsl.inc"

}  // namespace

constinit const ltcfit::test::Shader ltcfit::test::kGlsl{
    "glsl",
    [](const Texture& matrix, const Texture& amplitude, float roughness, float nDotV) {
      return to(ltcFetch({{&matrix}}, {{&amplitude}}, roughness, nDotV));
    },
    [](const Texture& table, int nAlpha, int nLambda, float alphaX, float alphaY, Vec3 view) {
      return to(ltcFetchAnisotropic({{&table}}, ivec2(nAlpha, nLambda), alphaX, alphaY, from(view)));
    },
    [](Vec3 n, Vec3 v) { return to(ltcFrame(from(n), from(v))); },
    [](const Mat3& inverse, const std::array<Vec3, 4>& v) {
      return ltcQuad(from(inverse), from(v[0]), from(v[1]), from(v[2]), from(v[3]));
    },
    [](const Mat3& inverse, const std::vector<Vec3>& vertices) {
      vec3 v[LTC_MAX_VERTICES];
      for (std::size_t i = 0; i < vertices.size(); ++i) v[i] = from(vertices[i]);
      return ltcPolygon(from(inverse), v, static_cast<int>(vertices.size()));
    },
    [](const Mat3& inverse, const std::array<Vec3, 4>& v) {
      return to(ltcVectorFormFactor(from(inverse), from(v[0]), from(v[1]), from(v[2]), from(v[3])));
    },
    [](Vec3 f) { return ltcProxySphere(from(f)); },
    [](const Texture& table, Vec3 f) { return ltcProxySphereTable({{&table}}, from(f)); },
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
      vec4 s[ltc_iso_rows];
      vec2 a[ltc_iso_rows];
      for (std::size_t j = 0; j < ltc_iso_rows; ++j) {
        s[j] = {shape[j][0], shape[j][1], shape[j][2], shape[j][3]};
        a[j] = {amplitude[j][0], amplitude[j][1]};
      }
      return to(ltc_iso_fetchCollapsed(s, a, roughness, nDotV));
    },
    ltc_iso_rows};
