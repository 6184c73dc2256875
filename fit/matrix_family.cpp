#include "fit/matrix_family.h"

#include <array>
#include <cmath>

namespace ltcfit {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

Matrix3d unit(int row, int column) {
  Matrix3d m = Matrix3d::Zero();
  m(row, column) = 1.0;
  return m;
}

Matrix3d diagonal(double a, double b, double c) {
  return Matrix3d(Vector3d(a, b, c).normalized().asDiagonal());
}

// The aperture as a whole against the third column, and one aperture against the other.
const Matrix3d kWiden = diagonal(1.0, 1.0, -2.0);
const Matrix3d kStretch = diagonal(1.0, -1.0, 0.0);

std::vector<Matrix3d> makeBasis(MatrixFamily family) {
  switch (family) {
    case MatrixFamily::kGeneral:
      return {kWiden,     kStretch,  (unit(0, 1) + unit(1, 0)) / std::sqrt(2.0), unit(0, 2), unit(1, 2),
              unit(2, 0), unit(2, 1)};
    case MatrixFamily::kMirrorY:
      return {kWiden, kStretch, unit(0, 2), unit(2, 0)};
    case MatrixFamily::kMirrorX:
      return {kWiden, kStretch, unit(1, 2), unit(2, 1)};
    case MatrixFamily::kMirrorXY:
      return {kWiden, kStretch};
    case MatrixFamily::kRotational:
      break;
  }
  return {kWiden};
}

}  // namespace

const std::vector<Matrix3d>& familyBasis(MatrixFamily family) {
  static const std::array<std::vector<Matrix3d>, 5> kBases{
      makeBasis(MatrixFamily::kGeneral), makeBasis(MatrixFamily::kMirrorY), makeBasis(MatrixFamily::kMirrorX),
      makeBasis(MatrixFamily::kMirrorXY), makeBasis(MatrixFamily::kRotational)};
  return kBases[static_cast<std::size_t>(family)];
}

Matrix3d projectOnFamily(const Matrix3d& m, MatrixFamily family) {
  if (family == MatrixFamily::kGeneral) return m;
  Matrix3d out = m.diagonal().asDiagonal();
  if (family == MatrixFamily::kMirrorY) {
    out(0, 2) = m(0, 2);
    out(2, 0) = m(2, 0);
  } else if (family == MatrixFamily::kMirrorX) {
    out(1, 2) = m(1, 2);
    out(2, 1) = m(2, 1);
  } else if (family == MatrixFamily::kRotational) {
    out(0, 0) = out(1, 1) = 0.5 * (m(0, 0) + m(1, 1));
  }
  return out;
}

Matrix3d changedBy(const Matrix3d& m, MatrixFamily family, std::span<const double> p) {
  const std::vector<Matrix3d>& basis = familyBasis(family);
  Matrix3d change = Matrix3d::Identity();
  for (std::size_t k = 0; k < p.size(); ++k) change += p[k] * basis[k];
  return m * change;
}

}  // namespace ltcfit
