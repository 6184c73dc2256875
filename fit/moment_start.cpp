#include "fit/moment_start.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ltc/alignment.h"

namespace ltcfit {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// Enough samples and steps for a start; the fit does the rest.
constexpr std::size_t kMostStartSamples = 512;
constexpr int kRounds = 2;
constexpr int kStepsPerRound = 8;
// Directions further than this from the frame's axis have slopes too long to tell anything.
constexpr double kSmallestCosine = 0.02;
// Relative to the larger one: keeps the smaller aperture of a lobe that is a line to rounding.
constexpr double kSmallestRatio = 1e-6;

// Columns X, Y, Z = direction; Y is as near to y as can be, so that symmetric lobes get symmetric frames.
Matrix3d frameOf(const Vector3d& direction) {
  const Vector3d z = direction.normalized();
  const Vector3d helper = std::abs(z.y()) < 0.9 ? Vector3d::UnitY() : Vector3d(-Vector3d::UnitZ());
  const Vector3d x = helper.cross(z).normalized();
  Matrix3d frame;
  frame << x, z.cross(x), z;
  return frame;
}

struct SlopeShape {
  Vector2d centre = Vector2d::Zero();
  Matrix2d scatter = Matrix2d::Identity();  // A A^T
};

// EM for the t distribution with nu = 2: weights (nu + 2) / (nu + nu d^2) = 2 / (1 + d^2), and a scatter of
// nu times its own scale matrix, in units where the
// density is (1 + d^2)^-2.
SlopeShape fitSlopes(const std::vector<Vector2d>& slopes, const std::vector<double>& weights, SlopeShape s) {
  for (int step = 0; step < kStepsPerRound; ++step) {
    const Matrix2d inverse = s.scatter.inverse();
    double total = 0.0;
    double mass = 0.0;
    Vector2d first = Vector2d::Zero();
    Matrix2d second = Matrix2d::Zero();
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      const Vector2d d = slopes[i] - s.centre;
      const double w = weights[i] * 2.0 / (1.0 + d.dot(inverse * d));
      mass += weights[i];
      total += w;
      first += w * d;
      second += w * d * d.transpose();
    }
    s.centre += first / total;
    s.scatter = 2.0 * second / mass;
    // a line: widen it a little across
    s.scatter += kSmallestRatio * kSmallestRatio * s.scatter.trace() * Matrix2d::Identity();
  }
  return s;
}

}  // namespace

Matrix3d momentStart(const LobeSamples& samples) {
  const std::size_t n = samples.directions.size();
  const std::size_t stride = std::max<std::size_t>(1, n / kMostStartSamples);
  Vector3d axis = samples.mean();
  Matrix3d m = Matrix3d::Identity();
  for (int round = 0; round < kRounds; ++round) {
    const Matrix3d frame = frameOf(axis);
    std::vector<Vector2d> slopes;
    std::vector<double> weights;
    for (std::size_t i = 0; i < n; i += stride) {
      const Vector3d local = frame.transpose() * samples.directions[i];
      if (local.z() < kSmallestCosine) continue;
      slopes.emplace_back(local.head<2>() / local.z());
      weights.push_back(samples.weights[i]);
    }
    if (slopes.empty()) break;
    SlopeShape start;
    double mass = 0.0;
    for (double w : weights) mass += w;
    start.scatter.setZero();
    for (std::size_t i = 0; i < slopes.size(); ++i)
      start.scatter += weights[i] / mass * slopes[i] * slopes[i].transpose();
    start.scatter += kSmallestRatio * kSmallestRatio * start.scatter.trace() * Matrix2d::Identity();
    const SlopeShape shape = fitSlopes(slopes, weights, start);
    Matrix3d local = Matrix3d::Identity();
    local.topLeftCorner<2, 2>() = Matrix2d(shape.scatter.llt().matrixL());
    local.col(2).head<2>() = shape.centre;
    m = frame * local;
    axis = m.col(2);
  }
  return align(m).m;
}

}  // namespace ltcfit
