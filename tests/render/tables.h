// The tables in data/ as textures, by the contract in the head of ltc.glsl, and how two matrices are
// compared.
#pragma once

#include <Eigen/Core>
#include <string>

#include "ltc/table.h"
#include "tests/render/shader.h"

namespace ltcfit::test {

/// data/ltc_iso.json as shaders read it: its inverse divided by the middle element.
const Table& isotropicTable();
/// data/ltc_aniso.json.
const Table& anisotropicTable();

struct IsotropicTextures {
  Texture matrix;
  Texture amplitude;
};
IsotropicTextures isotropicTextures(const Table& table);
Texture anisotropicTexture(const Table& table);

Eigen::Vector3d toEigen(const Vec3& v);
Eigen::Matrix3d toEigen(const Mat3& m);
Vec3 toVec3(const Eigen::Vector3d& v);

/// How far `inverse` times m is from a multiple of the unit matrix, largest entry: by so much, in the frame
/// of the cosine, the shader's lobe is displaced. Where det m < 0, m with y flipped is meant, the same lobe.
/// Infinite where that is not finite, or the multiple not positive.
double displacement(const Mat3& inverse, const Eigen::Matrix3d& m);

/// Raises `worst` to `error`; NaN, which std::max passes over, counts as infinite.
void raise(double& worst, double error);

}  // namespace ltcfit::test
