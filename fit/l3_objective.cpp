#include "fit/l3_objective.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "ggx/random.h"
#include "ltc/ltc.h"

namespace ltcfit {
namespace {

// Samples are worked off in blocks that stay in the first-level cache.
constexpr std::size_t kBlock = 128;
// Partial sums: a fixed order of addition whatever the vector width, so that no result depends on it.
constexpr std::size_t kLanes = 8;

class LaneSum {
 public:
  void add(const double* terms, std::size_t n) {
    std::size_t i = 0;
    for (; i + kLanes <= n; i += kLanes) {
      for (std::size_t k = 0; k < kLanes; ++k) lanes_[k] += terms[i + k];
    }
    for (; i < n; ++i) lanes_[i % kLanes] += terms[i];
  }
  double total() const {
    return ((lanes_[0] + lanes_[1]) + (lanes_[2] + lanes_[3])) +
           ((lanes_[4] + lanes_[5]) + (lanes_[6] + lanes_[7]));
  }

 private:
  std::array<double, kLanes> lanes_{};
};

}  // namespace

L3Objective::L3Objective(const Lobe& lobe, double albedo, int samples, std::uint64_t seed)
    : lobe_(lobe), albedo_(albedo) {
  const std::size_t n = static_cast<std::size_t>(samples);
  for (auto* v : {&lobeX_, &lobeY_, &lobeZ_, &lobeEval_, &lobePdf_, &cosX_, &cosY_, &cosZ_}) v->resize(n);
  const R2Sequence points(seed);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d u = points(i);
    const LobeSample s = lobe.sample(u);
    const Eigen::Vector3d x = sampleCosine(u);
    lobeX_[i] = s.wi.x();
    lobeY_[i] = s.wi.y();
    lobeZ_[i] = s.wi.z();
    cosX_[i] = x.x();
    cosY_[i] = x.y();
    cosZ_[i] = x.z();
  }
  lobe.evalBatch(lobeX_, lobeY_, lobeZ_, lobeEval_, lobePdf_);
  for (std::size_t i = 0; i < n; ++i) {
    const double e = lobeEval_[i];
    if (e > 0.0) lobeCube_ += e * e * e / lobePdf_[i];
  }
  lobeCube_ /= static_cast<double>(n);
}

double L3Objective::operator()(const Eigen::Matrix3d& m) const {
  const double det = std::abs(m.determinant());
  const Eigen::Matrix3d inv = m.inverse();
  if (!(det > 0.0) || !std::isfinite(det) || !inv.allFinite()) return std::numeric_limits<double>::infinity();

  const std::size_t n = lobeX_.size();
  const double densityScale = std::numbers::inv_pi / det;
  const double nD = albedo_;
  LaneSum sum;
  std::array<double, kBlock> term;

  // Directions of the lobe: its eval and pdf are known, f follows from y = M^-1 w.
  const double i00 = inv(0, 0), i01 = inv(0, 1), i02 = inv(0, 2);
  const double i10 = inv(1, 0), i11 = inv(1, 1), i12 = inv(1, 2);
  const double i20 = inv(2, 0), i21 = inv(2, 1), i22 = inv(2, 2);
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    const std::size_t count = std::min(kBlock, n - begin);
    const double* const x = lobeX_.data() + begin;
    const double* const y = lobeY_.data() + begin;
    const double* const z = lobeZ_.data() + begin;
    const double* const eval = lobeEval_.data() + begin;
    const double* const pdf = lobePdf_.data() + begin;
#pragma omp simd
    for (std::size_t i = 0; i < count; ++i) {
      const double yx = i00 * x[i] + i01 * y[i] + i02 * z[i];
      const double yy = i10 * x[i] + i11 * y[i] + i12 * z[i];
      const double yz = i20 * x[i] + i21 * y[i] + i22 * z[i];
      const double r2 = yx * yx + yy * yy + yz * yz;
      const double f = densityScale * (yz > 0.0 ? yz : 0.0) / (r2 * r2);
      const double d = std::abs(eval[i] - nD * f);
      // both pdfs are 0 only where both functions are
      term[i] = d * d * d / (f + pdf[i] + 1e-300);
    }
    sum.add(term.data(), count);
  }

  // Directions of the LTC: f follows from the original sample, the lobe is evaluated.
  const double m00 = m(0, 0), m01 = m(0, 1), m02 = m(0, 2);
  const double m10 = m(1, 0), m11 = m(1, 1), m12 = m(1, 2);
  const double m20 = m(2, 0), m21 = m(2, 1), m22 = m(2, 2);
  std::array<double, kBlock> wx, wy, wz, density, eval, pdf;
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    const std::size_t count = std::min(kBlock, n - begin);
    const double* const x = cosX_.data() + begin;
    const double* const y = cosY_.data() + begin;
    const double* const z = cosZ_.data() + begin;
#pragma omp simd
    for (std::size_t i = 0; i < count; ++i) {
      const double vx = m00 * x[i] + m01 * y[i] + m02 * z[i];
      const double vy = m10 * x[i] + m11 * y[i] + m12 * z[i];
      const double vz = m20 * x[i] + m21 * y[i] + m22 * z[i];
      const double r2 = vx * vx + vy * vy + vz * vz;
      const double r = std::sqrt(r2);
      const double s = 1.0 / r;
      wx[i] = vx * s;
      wy[i] = vy * s;
      wz[i] = vz * s;
      // cosine density over the Jacobian |det M| / |M x|^3
      density[i] = densityScale * z[i] * r2 * r;
    }
    lobe_.evalBatch({wx.data(), count}, {wy.data(), count}, {wz.data(), count}, {eval.data(), count},
                    {pdf.data(), count});
#pragma omp simd
    for (std::size_t i = 0; i < count; ++i) {
      const double d = std::abs(eval[i] - nD * density[i]);
      term[i] = d * d * d / (density[i] + pdf[i] + 1e-300);
    }
    sum.add(term.data(), count);
  }
  return sum.total() / static_cast<double>(n);
}

}  // namespace ltcfit
