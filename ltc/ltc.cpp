#include "ltc/ltc.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/diagnostics.h"

namespace ltcfit {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double cosineDensity(const Vector3d& w) {
  return std::max(0.0, w.z()) * std::numbers::inv_pi;
}

Vector3d sampleCosine(const Eigen::Vector2d& u) {
  const double r = std::sqrt(u.x());
  const double phi = 2.0 * std::numbers::pi * u.y();
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0, 1.0 - u.x()))};
}

Ltc::Ltc(const Matrix3d& m) : m_(m), mInv_(m.inverse()), det_(m.determinant()) {
  if (!mInv_.allFinite() || !(std::abs(det_) > 0.0)) {
    abortWith("Ltc: singular matrix [%g %g %g; %g %g %g; %g %g %g]", m(0, 0), m(0, 1), m(0, 2), m(1, 0),
              m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2));
  }
}

double Ltc::density(const Vector3d& w) const {
  // D_o(y / |y|) / (|det M| |y|^3) with y = M^-1 w: one power of |y| more from normalising the cosine
  const Vector3d y = mInv_ * w;
  if (y.z() <= 0.0) return 0.0;
  const double r2 = y.squaredNorm();
  return y.z() * std::numbers::inv_pi / (std::abs(det_) * r2 * r2);
}

Matrix3d Ltc::densityGradient(const Vector3d& w) const {
  // log f = log y_z - 4 log |y| - log |det M| + const, and dy = -M^-1 dM y, so
  //   d log f / dM = -(M^-T e_z) y^T / y_z + 4 (M^-T y) y^T / |y|^2 - M^-T.
  const Vector3d y = mInv_ * w;
  if (y.z() <= 0.0) return Matrix3d::Zero();
  const Matrix3d mInvT = mInv_.transpose();
  const Vector3d v = 4.0 / y.squaredNorm() * (mInvT * y) - mInvT.col(2) / y.z();
  return density(w) * (v * y.transpose() - mInvT);
}

double Ltc::jacobian(const Vector3d& x) const {
  const double r = (m_ * x).norm();
  return std::abs(det_) / (r * r * r);
}

double Ltc::inverseJacobian(const Vector3d& w) const {
  const double r = (mInv_ * w).norm();
  return 1.0 / (std::abs(det_) * r * r * r);
}

double Ltc::massBelowHorizon() const {
  // (1 - v.z) / 2 for v = row 2 normalised, without the cancellation when nearly nothing lies below
  const double x2 = m_(2, 0) * m_(2, 0) + m_(2, 1) * m_(2, 1);
  const double z = m_(2, 2);
  const double length = std::sqrt(x2 + z * z);
  if (length == 0.0) return 0.0;
  return z > 0.0 ? 0.5 * x2 / (length * (length + z)) : 0.5 * (1.0 - z / length);
}

bool isInvertibleInFloat(const Matrix3d& m) {
  const Eigen::Matrix3f f = m.cast<float>();
  const float det = f.determinant();
  return f.allFinite() && det != 0.0f && std::isfinite(det) && f.inverse().allFinite();
}

}  // namespace ltcfit
