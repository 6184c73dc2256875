#include "fit/isotropic_family.h"

#include <algorithm>
#include <cmath>

namespace ltcfit {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Keeps the logarithm finite for a start whose column vanished.
constexpr double kSmallestAperture = 1e-12;

}  // namespace

std::string_view familyName(IsotropicFamily family) {
  return family == IsotropicFamily::kPlane4 ? "4" : "3";
}

Matrix3d frameAbout(const Vector3d& direction) {
  const double length = std::hypot(direction.x(), direction.z());
  const double s = direction.x() / length;
  const double c = direction.z() / length;
  Matrix3d frame;
  frame << c, 0, s,  //
      0, 1, 0,       //
      -s, 0, c;
  return frame;
}

IsotropicParametrization::IsotropicParametrization(IsotropicFamily family, bool normalView,
                                                   const Vector3d& mean, const Matrix3d& start)
    : family_(family), normalView_(normalView) {
  const auto aperture = [](double x) { return std::max(std::abs(x), kSmallestAperture); };
  if (normalView_) {
    frame_ = Matrix3d::Identity();
    start_ = {std::log(aperture(start(0, 0) / start(2, 2)))};
    return;
  }
  frame_ = frameAbout(family_ == IsotropicFamily::kPlane4 ? Vector3d(start.col(2)) : mean);
  Matrix3d local = frame_.transpose() * start;
  local /= local(2, 2);
  scale_ = aperture(local(0, 0));
  start_ = {std::log(scale_), std::log(aperture(local(1, 1)))};
  if (family_ == IsotropicFamily::kPlane4) {
    start_.push_back(local(0, 0) < 0.0 ? -local(2, 0) : local(2, 0));
    start_.push_back(0.0);
  } else {
    start_.push_back(local(0, 2) / scale_);
  }
}

Matrix3d IsotropicParametrization::matrix(std::span<const double> v) const {
  const double p = std::exp(v[0]);
  if (normalView_) return Eigen::DiagonalMatrix<double, 3>(p, p, 1.0);
  const double q = std::exp(v[1]);
  Matrix3d local;
  if (family_ == IsotropicFamily::kMeanFrame3) {
    local << p, 0, scale_ * v[2],  //
        0, q, 0,                   //
        0, 0, 1;
    return frame_ * local;
  }
  local << p, 0, 0,  //
      0, q, 0,       //
      v[2], 0, 1;
  const double angle = scale_ * v[3];
  return frame_ * frameAbout({std::sin(angle), 0.0, std::cos(angle)}) * local;
}

}  // namespace ltcfit
