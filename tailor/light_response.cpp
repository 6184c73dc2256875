#include "tailor/light_response.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ggx/random.h"
#include "ltc/ltc.h"
#include "ltc/polygon.h"
#include "report/random_lights.h"

namespace ltcfit {

using Eigen::Matrix3d;
using Eigen::VectorXd;

namespace {

constexpr Eigen::Index kNorm = 9;
constexpr Eigen::Index kFresnel = 10;

Matrix3d matrixPart(const StoredEntry& entry) {
  Matrix3d m;
  for (Eigen::Index k = 0; k < 9; ++k) m(k / 3, k % 3) = entry[k];
  return m;
}

}  // namespace

MatrixStorage lookUpStorage(bool isotropic) {
  return isotropic ? MatrixStorage::kMinv : MatrixStorage::kM;
}

StoredEntry storedEntry(const Matrix3d& m, double norm, double fresnel, MatrixStorage stores) {
  const Matrix3d stored = stores == MatrixStorage::kM
                              ? normalized(m, MatrixNormalization::kThirdColumnUnit)
                              : normalized(m.inverse(), MatrixNormalization::kMiddleElement);
  StoredEntry entry;
  for (Eigen::Index k = 0; k < 9; ++k) entry[k] = stored(k / 3, k % 3);
  entry[kNorm] = norm;
  entry[kFresnel] = fresnel;
  return entry;
}

Matrix3d matrixOf(const StoredEntry& entry, MatrixStorage stores) {
  const Matrix3d stored = matrixPart(entry);
  return stores == MatrixStorage::kM ? stored : Matrix3d(stored.inverse());
}

LightResponse::LightResponse(const LookUp& lookUp, const StoredEntry& truth, MatrixStorage stores,
                             std::uint64_t seed)
    : lookUp_(lookUp), truth_(truth), stores_(stores) {
  Random random(seed);
  for (double size : kLightSizes) {
    for (std::size_t i = 0; i < kResponseLights; ++i) lights_.push_back(randomLight(size, random));
  }
  scale_ = truth[kNorm] / std::max(amplitude(truth), kLeastReflectance * truth[kNorm]);
  m_ = matrixOf(truth, stores);
  mInverse_ = m_.inverse();
  const double third = m_.col(2).norm();
  const double width = std::sqrt(std::abs(m_.determinant()) / (third * third * third));
  widening_ = std::max(1.0, kSharpWidth / width);
  widened_ = m_ * Eigen::Vector3d(widening_, widening_, 1.0).asDiagonal();
  exact_ = radiances(truth);
}

double LightResponse::amplitude(const StoredEntry& entry) const {
  return lookUp_.f0 * entry[kNorm] + (lookUp_.f90 - lookUp_.f0) * entry[kFresnel];
}

VectorXd LightResponse::radiances(const StoredEntry& entry) const {
  VectorXd out(static_cast<Eigen::Index>(lights_.size()));
  const Matrix3d m = matrixOf(entry, stores_);
  if (!isInvertibleInFloat(m)) return VectorXd::Constant(out.size(), std::numeric_limits<double>::infinity());
  const Matrix3d changed = widened_ * (mInverse_ * m);
  if (!(std::abs(changed.determinant()) > 0.0))
    return VectorXd::Constant(out.size(), std::numeric_limits<double>::infinity());
  const Ltc ltc(changed);
  for (std::size_t i = 0; i < lights_.size(); ++i)
    out[static_cast<Eigen::Index>(i)] = scale_ * amplitude(entry) * ltcPolygonIntegral(ltc, lights_[i]);
  return out;
}

double LightResponse::difference(const StoredEntry& entry) const {
  const VectorXd d = radiances(entry) - exact_;
  return std::sqrt(d.squaredNorm() / (widening_ * static_cast<double>(lights_.size())));
}

Eigen::Matrix<double, 2, 11> LightResponse::displacement() const {
  Eigen::Matrix<double, 2, 11> out = Eigen::Matrix<double, 2, 11>::Zero();
  for (Eigen::Index k = 0; k < 9; ++k) {
    Matrix3d unit = Matrix3d::Zero();
    unit(k / 3, k % 3) = 1.0;
    const Matrix3d p = stores_ == MatrixStorage::kM ? Matrix3d(mInverse_ * unit) : Matrix3d(-unit * m_);
    out.col(k) = p.block<2, 1>(0, 2);
  }
  return out;
}

Eigen::Matrix<double, 11, 11> LightResponse::metric() const {
  Eigen::Matrix<double, 11, 11> sum = Eigen::Matrix<double, 11, 11>::Zero();
  const Ltc ltc(widened_);
  for (const Quad& light : lights_) {
    // the derivative is by P of M (I + P): P = M^-1 dM, and for a change of the inverse P = -dMinv M
    Matrix3d byP;
    const double integral = ltcPolygonIntegral(ltc, light, &byP);
    const Matrix3d byEntry = stores_ == MatrixStorage::kM ? Matrix3d(mInverse_.transpose() * byP)
                                                          : Matrix3d(-byP * m_.transpose());
    StoredEntry j;
    for (Eigen::Index k = 0; k < 9; ++k) j[k] = scale_ * amplitude(truth_) * byEntry(k / 3, k % 3);
    j[kNorm] = scale_ * lookUp_.f0 * integral;
    j[kFresnel] = scale_ * (lookUp_.f90 - lookUp_.f0) * integral;
    sum += j * j.transpose();
  }
  return sum / (widening_ * static_cast<double>(lights_.size()));
}

}  // namespace ltcfit
