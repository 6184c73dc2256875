#include "ltc/alignment.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <vector>

namespace ltcfit {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kRings = 24;
constexpr int kSectors = 48;  // a multiple of 4: mirrored by the x and the y axis

// Rings of equal cosine mass, taken at their middle. Enough for the angle to 1e-4: what it decides is how
// neighbours interpolate, not the lobe.
std::vector<Vector3d> makeCosineGrid() {
  std::vector<Vector3d> grid;
  for (int i = 0; i < kRings; ++i) {
    const double r2 = (i + 0.5) / kRings;
    for (int j = 0; j < kSectors; ++j) {
      const double phi = 2.0 * std::numbers::pi * (j + 0.5) / kSectors;
      const double r = std::sqrt(r2);
      grid.emplace_back(r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - r2));
    }
  }
  return grid;
}

}  // namespace

// E |N(M Q x) - x|^2 = 2 - 2 E[N(M Q x) . x]. The cosine is invariant under Q, so with x' = Q x the mean is
// E[N(M x') . Q^T x'] = E[Q N(M x') . x'] = sum_ij Q_ij C_ij + C_zz, C_ij = E[x_i N(M x)_j]. For a rotation
// by a, sum Q_ij C_ij = cos a (C00 + C11) + sin a (C10 - C01); for a rotation after a flip of y,
// cos a (C00 - C11) + sin a (C10 + C01): the amplitudes of the two are compared for flipWouldBeCloser.
Alignment align(const Matrix3d& m) {
  static const std::vector<Vector3d> kGrid = makeCosineGrid();
  Matrix2d c = Matrix2d::Zero();
  double czz = 0.0;
  for (const Vector3d& x : kGrid) {
    const Vector3d y = (m * x).normalized();
    c += x.head<2>() * y.head<2>().transpose();
    czz += x.z() * y.z();
  }
  c /= static_cast<double>(kGrid.size());
  czz /= static_cast<double>(kGrid.size());
  const double along = c(0, 0) + c(1, 1);
  const double across = c(1, 0) - c(0, 1);
  const double rotated = std::hypot(along, across);
  Alignment out;
  out.angle = rotated > 0.0 ? std::atan2(across, along) : 0.0;
  const double cosA = rotated > 0.0 ? along / rotated : 1.0;
  const double sinA = rotated > 0.0 ? across / rotated : 0.0;
  Matrix3d q;
  q << cosA, -sinA, 0.0,  //
      sinA, cosA, 0.0,    //
      0.0, 0.0, 1.0;
  out.m = m * q;
  // (a + d)^2 + (b - c)^2 <= 2 (a^2 + b^2 + c^2 + d^2)
  const double most = std::sqrt(2.0) * c.norm();
  out.strength = most > 0.0 ? rotated / most : 0.0;
  out.distanceBefore = 2.0 - 2.0 * (along + czz);
  out.distanceAfter = 2.0 - 2.0 * (rotated + czz);
  out.flipWouldBeCloser = std::hypot(c(0, 0) - c(1, 1), c(1, 0) + c(0, 1)) > rotated;
  return out;
}

}  // namespace ltcfit
