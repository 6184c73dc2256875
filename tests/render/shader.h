// The shader snippets, compiled as C++: the very text of the .glsl and .hlsl files, between GLM and a few
// lines that stand for what the languages have built in.
#pragma once

#include <array>
#include <ostream>
#include <span>
#include <vector>

#include "tests/render/texture.h"

namespace ltcfit::test {

using Vec3 = std::array<float, 3>;
using Mat3 = std::array<Vec3, 3>;  // rows

struct ShaderEntry {
  Mat3 inverse;
  float norm;
  float fresnel;
};

/// What the look-ups of single tables take, each what it needs (export/shader_lookup.h).
struct LookupArguments {
  float roughness = 0.0f;
  float nDotV = 1.0f;
  float alphaX = 0.0f;
  float alphaY = 0.0f;
  Vec3 view{0.0f, 0.0f, 1.0f};
};

/// The generated look-up of one of tailoredTables (tests/support/tailored.h).
struct Lookup {
  const char* name;
  ShaderEntry (*fetch)(const Texture& matrix, const Texture& amplitude, const LookupArguments& arguments);
};

struct Shader {
  const char* name;
  ShaderEntry (*fetch)(const Texture& matrix, const Texture& amplitude, float roughness, float nDotV);
  ShaderEntry (*fetchAnisotropic)(const Texture& table, int nAlpha, int nLambda, float alphaX, float alphaY,
                                  Vec3 view);
  Mat3 (*frame)(Vec3 n, Vec3 v);
  float (*quad)(const Mat3& inverse, const std::array<Vec3, 4>& vertices);
  float (*polygon)(const Mat3& inverse, const std::vector<Vec3>& vertices);  // up to 8
  Vec3 (*formFactor)(const Mat3& inverse, const std::array<Vec3, 4>& vertices);
  float (*proxySphere)(Vec3 formFactor);
  float (*proxySphereTable)(const Texture& table, Vec3 formFactor);
  bool (*facing)(Vec3 v0, Vec3 v1, Vec3 v2);
  bool (*aboveSurface)(const std::array<Vec3, 4>& vertices);
  float (*arc)(float m2);
  Vec3 (*fresnel)(const ShaderEntry& entry, Vec3 f0, Vec3 f90);
  std::span<const Lookup> lookups;
  /// data/ltc_iso.cheb.glsl and .hlsl; how many rows the collapsed arrays have.
  ShaderEntry (*polynomials)(float roughness, float nDotV);
  ShaderEntry (*collapsed)(const std::vector<std::array<float, 4>>& shape,
                           const std::vector<std::array<float, 2>>& amplitude, float roughness, float nDotV);
  int rows;
};

inline std::ostream& operator<<(std::ostream& out, const Shader& shader) {
  return out << shader.name;
}

extern const Shader kGlsl;
/// Here dot, cross and mul fuse multiply and add, as GPUs may; in kGlsl they round every product.
extern const Shader kHlsl;

}  // namespace ltcfit::test
