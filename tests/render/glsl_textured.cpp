// ltc_textured.glsl as C++. Built with -fsingle-precision-constant, since there 1.0 is a float.
#include <glm/glm.hpp>

#include "tests/render/textured_shader.h"

namespace {

using namespace glm;

struct sampler2D {
  const ltcfit::test::MipMaps* levels;
};
vec4 textureLod(sampler2D s, vec2 at, float lod) {
  const auto t = ltcfit::test::sampleTrilinear(*s.levels, at.x, at.y, lod);
  return {t[0], t[1], t[2], t[3]};
}

// swizzles as members are not of GLM's default build
struct Colour : vec4 {
  vec3 rgb;
  explicit Colour(vec4 v) : vec4(v), rgb(v) {}
};
#define textureLod(s, at, lod) Colour(textureLod(s, at, lod))
#include "render/shaders/ltc_textured.glsl"
#undef textureLod

using ltcfit::test::Vec3;

vec3 from(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

constinit const ltcfit::test::TexturedShader ltcfit::test::kTexturedGlsl{
    "glsl",
    [](const Mat3& m, const std::array<Vec3, 4>& v, const MipMaps& picture, float margin,
       float lodScale) -> Vec3 {
      const mat3 inverse = transpose(mat3(from(m[0]), from(m[1]), from(m[2])));
      const vec3 colour = ltcLightColour(inverse, from(v[0]), from(v[1]), from(v[2]), from(v[3]), {&picture},
                                         margin, lodScale);
      return {colour.x, colour.y, colour.z};
    }};
