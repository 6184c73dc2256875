#include "fit/sliced_wasserstein_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/refusal.h"
#include "fit/moment_start.h"
#include "ggx/random.h"
#include "ltc/alignment.h"

namespace ltcfit {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Descents from one start; each but the first begins where the one before ended.
constexpr int kMostRounds = 12;
// A round that gains less ends them.
constexpr double kRoundGain = 1e-3;
// Two minima of few samples that differ by less are alike: that of the usual start is kept.
constexpr double kStartGain = 0.1;
// A descent that ends so much above the usual start's has not arrived.
constexpr double kArrivedLoss = 1.01;
// The change of the loss that a step of 1 in the parameters makes is of the order of the lobe's width times
// this; BFGS then starts with the right step lengths. 0.05 .. 0.2 take the same number of evaluations to 5 %.
constexpr double kCurvatureFactor = 0.1;
// Of the differences for the Hessian, in the parameters: 0.02 .. 0.1 need 10.7 .. 11.7 evaluations of the
// last level after it (26 without), smallest curvatures of 0.01 .. 0.05 the same.
constexpr double kHessianStep = 0.05;
constexpr double kSmallestCurvature = 0.02;
// Lobes narrower than this get so many more samples of the LTC: at grazing view their loss is all tail. Seven
// nodes of the 8^4 table (alpha_y at the floor, phi = theta = 90 degrees) otherwise end, by the luck of the
// lattice, at twice the SW1 that they can have.
constexpr double kSharpWidth = 0.01;
constexpr int kSharpFactor = 8;
constexpr int kMostSamples = 1 << 20;

int slicesOf(MatrixFamily family, int slices) {
  switch (family) {
    case MatrixFamily::kGeneral:
      return slices;
    case MatrixFamily::kMirrorY:
    case MatrixFamily::kMirrorX:
      return (slices + 1) / 2;
    case MatrixFamily::kMirrorXY:
    case MatrixFamily::kRotational:
      break;
  }
  return (slices + 3) / 4;
}

// The first `count` weighted samples: a prefix of an evenly spread sequence is evenly spread.
LobeSamples prefix(const LobeSamples& samples, std::size_t count) {
  const auto n = static_cast<std::ptrdiff_t>(std::min(count, samples.directions.size()));
  LobeSamples out{{samples.directions.begin(), samples.directions.begin() + n},
                  {samples.weights.begin(), samples.weights.begin() + n}};
  double total = 0.0;
  for (double w : out.weights) total += w;
  for (double& w : out.weights) w /= total;
  return out;
}

// Width of an LTC to first order, at most 1.
double width(const Matrix3d& m) {
  return std::min(1.0, m.leftCols<2>().norm() / m.col(2).norm());
}

// Where and how a descent moves: M = base (I + sum of (A q)_k B_k), A A^T about the inverse of the Hessian,
// so that all q are alike.
struct Chart {
  MatrixFamily family;
  Matrix3d base;
  Eigen::MatrixXd a;
};

// What is minimised: the loss plus `leak` times the mass below the horizon, (1 - v.z / |v|) / 2 with v row 2
// of M (Ltc::massBelowHorizon).
struct Objective {
  ProjectedCdfLoss& loss;
  double leak;

  double operator()(const Matrix3d& m, Matrix3d* gradient) const {
    double value = loss(m, gradient);
    if (leak == 0.0) return value;
    const Eigen::RowVector3d v = m.row(2);
    const double length = v.norm();
    const double cosine = v.z() / length;
    value += 0.5 * leak * (1.0 - cosine);
    if (gradient != nullptr)
      gradient->row(2) -= 0.5 * leak / length * (Eigen::RowVector3d::UnitZ() - cosine / length * v);
    return value;
  }
};

// d / dp at M (I + sum of p B): <base^T dL/dM, B>.
Eigen::VectorXd relativeGradient(MatrixFamily family, const Matrix3d& base, const Matrix3d& gradient) {
  const std::vector<Matrix3d>& basis = familyBasis(family);
  const Matrix3d relative = base.transpose() * gradient;
  Eigen::VectorXd g(static_cast<Eigen::Index>(basis.size()));
  for (Eigen::Index k = 0; k < g.size(); ++k)
    g[k] = relative.cwiseProduct(basis[static_cast<std::size_t>(k)]).sum();
  return g;
}

// A first guess of the curvatures. What moves the lobe, column 2 of P, moves it by its own width for a step
// of 1: where the target is many widths away, as from a bad start, that many are one step.
Chart plainChart(const SlicedWassersteinTarget& target, const Matrix3d& base) {
  const std::vector<Matrix3d>& basis = familyBasis(target.family);
  const double w = std::max(width(base), 1e-12);
  const double away = (base.col(2).normalized() - target.start.col(2).normalized()).norm() / w;
  Eigen::VectorXd scale(static_cast<Eigen::Index>(basis.size()));
  for (std::size_t k = 0; k < basis.size(); ++k) {
    const bool moves = basis[k].col(2).head<2>().norm() > 0.5;
    scale[static_cast<Eigen::Index>(k)] =
        std::sqrt((moves ? std::max(1.0, away) : 1.0) / (kCurvatureFactor * w));
  }
  return {target.family, base, scale.asDiagonal()};
}

// By central differences of the gradient. The loss is only piecewise smooth, hence the wide step and the
// floor on the curvatures; BFGS corrects the rest.
Chart hessianChart(const Objective& objective, const SlicedWassersteinTarget& target, const Matrix3d& base) {
  const MatrixFamily family = target.family;
  const std::size_t n = familyBasis(family).size();
  Eigen::MatrixXd hessian(n, n);
  std::vector<double> p(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    Matrix3d gradient;
    p[k] = kHessianStep;
    objective(changedBy(base, family, p), &gradient);
    hessian.col(column) = relativeGradient(family, base, gradient);
    p[k] = -kHessianStep;
    objective(changedBy(base, family, p), &gradient);
    hessian.col(column) -= relativeGradient(family, base, gradient);
    p[k] = 0.0;
  }
  hessian = (0.25 / kHessianStep * (hessian + hessian.transpose())).eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(hessian);
  const double most = eigen.eigenvalues().cwiseAbs().maxCoeff();
  if (!(most > 0.0)) return plainChart(target, base);
  const Eigen::VectorXd curvature = eigen.eigenvalues().cwiseAbs().cwiseMax(kSmallestCurvature * most);
  return {family, base, eigen.eigenvectors() * curvature.cwiseSqrt().cwiseInverse().asDiagonal()};
}

Matrix3d matrixAt(const Chart& chart, std::span<const double> q) {
  const Eigen::VectorXd p = chart.a * Eigen::Map<const Eigen::VectorXd>(q.data(), chart.a.cols());
  return changedBy(chart.base, chart.family, {p.data(), static_cast<std::size_t>(p.size())});
}

OptimizerResult descend(const Objective& objective, const Chart& chart, const BfgsOptions& options,
                        Matrix3d* m) {
  const GradientCostFunction cost = [&](std::span<const double> q, double* gradient) {
    const Matrix3d changed = matrixAt(chart, q);
    if (!(changed.determinant() > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    Matrix3d raw;
    const double value = objective(changed, gradient != nullptr ? &raw : nullptr);
    if (gradient != nullptr) {
      Eigen::Map<Eigen::VectorXd>(gradient, chart.a.cols()) =
          chart.a.transpose() * relativeGradient(chart.family, chart.base, raw);
    }
    return value;
  };
  const std::vector<double> zero(static_cast<std::size_t>(chart.a.cols()), 0.0);
  OptimizerResult result = minimizeBfgs(cost, zero, options);
  *m = matrixAt(chart, result.parameters);
  *m /= m->col(2).norm();
  return result;
}

}  // namespace

bool SlicedWassersteinFitOptions::isValid(std::string* error) const {
  const auto check = [&](bool ok, const std::string& message) {
    if (!ok) *error = message;
    return ok;
  };
  if (!check(!levels.empty(), "no levels")) return false;
  for (const SlicedWassersteinLevel& l : levels) {
    if (!check(l.samples >= 16 && l.samples <= 1 << 20,
               "samples = " + std::to_string(l.samples) + ", must be in 16..1048576") ||
        !check(l.slices >= 4 && l.slices <= 65536,
               "slices = " + std::to_string(l.slices) + ", must be in 4..65536") ||
        !check(l.targetSamples >= 16 && l.targetSamples <= 1 << 22,
               "target samples = " + std::to_string(l.targetSamples) + ", must be in 16..4194304")) {
      return false;
    }
  }
  if (!check(leakWeight >= 0.0 && leakWeight <= 100.0,
             "leak weight " + std::to_string(leakWeight) + ", must be in 0..100"))
    return false;
  return bfgs.isValid(error);
}

SlicedWassersteinFitOptions slicedWassersteinPreset(std::string_view name) {
  SlicedWassersteinFitOptions o;
  if (name == "fast") {
    o.levels = {{512, 24, 2048}, {1024, 64, 4096}};
  } else if (name == "fine") {
    o.levels = {{512, 24, 2048}, {8192, 256, 65536}};
  } else if (name != "standard") {
    throw Refusal("preset '" + std::string(name) + "' (fast, standard or fine)");
  }
  return o;
}

SlicedWassersteinTarget makeTarget(const Lobe& lobe, MatrixFamily family,
                                   const SlicedWassersteinFitOptions& options) {
  int most = 0;
  for (const SlicedWassersteinLevel& l : options.levels) most = std::max(most, l.targetSamples);
  LobeSamples samples = weightedSamples(lobe, most, mixSeed(options.seed, 30));
  const Matrix3d start = projectOnFamily(momentStart(samples), family);
  return {std::move(samples), start, family};
}

ProjectedCdfLoss makeLoss(const SlicedWassersteinTarget& target, const SlicedWassersteinLevel& level,
                          std::uint64_t seed) {
  const int samples = width(target.start) < kSharpWidth
                          ? std::max(level.samples, std::min(kSharpFactor * level.samples, kMostSamples))
                          : level.samples;
  return ProjectedCdfLoss(prefix(target.samples, static_cast<std::size_t>(level.targetSamples)), target.start,
                          cosineSamples(samples, mixSeed(seed, 31)),
                          familySlices(target.family, slicesOf(target.family, level.slices)));
}

SlicedWassersteinFit fitSlicedWasserstein(const SlicedWassersteinTarget& target, const Matrix3d& start,
                                          const SlicedWassersteinFitOptions& options,
                                          ProjectedCdfLoss& finest) {
  SlicedWassersteinFit fit;
  Matrix3d m = start / start.col(2).norm();
  if (m.determinant() < 0.0) m.col(1) *= -1.0;
  fit.startLoss = finest(m, nullptr);
  const double leak = options.leakWeight * width(target.start);
  const auto round = [&](const Objective& objective, const Chart& chart) {
    const OptimizerResult result = descend(objective, chart, options.bfgs, &m);
    fit.evaluations += result.evaluations;
    fit.termination = result.termination;
    return result.cost < (1.0 - kRoundGain) * result.startCost;
  };
  const auto descendFrom = [&](const Objective& objective, const Matrix3d& from) {
    m = from;
    for (int k = 0; k < kMostRounds && round(objective, plainChart(target, m)); ++k) {
    }
    return objective(m, nullptr);
  };
  bool elsewhere = m != target.start / target.start.col(2).norm();
  const auto rounds = [&](const Objective& objective) {
    const double own = descendFrom(objective, m);
    if (!elsewhere) return;
    elsewhere = false;
    const Matrix3d found = m;
    const Termination termination = fit.termination;
    const double usual = descendFrom(objective, target.start);
    fit.restarted = !(own <= kArrivedLoss * usual);
    if (own < (1.0 - kStartGain) * usual) {
      m = found;
      fit.termination = termination;
    }
  };
  std::optional<Chart> chart;
  for (std::size_t level = 0; level + 1 < options.levels.size(); ++level) {
    ProjectedCdfLoss coarse = makeLoss(target, options.levels[level], options.seed);
    const Objective objective{coarse, leak};
    rounds(objective);
    chart = hessianChart(objective, target, m);
    fit.evaluations += 2 * static_cast<int>(chart->a.cols());
  }
  const Objective objective{finest, leak};
  if (chart && objective(m, nullptr) <= objective(target.start, nullptr)) {
    chart->base = m;
    round(objective, *chart);
  } else {
    // no coarse level, or its few samples misled it, as where tails carry the loss (alpha = 1e-5 at grazing
    // view)
    m = chart ? target.start : m;
    rounds(objective);
  }
  for (int k = 0; k < kMostRounds && fit.termination != Termination::kConverged; ++k) {
    if (!round(objective, plainChart(target, m))) break;
  }
  fit.loss = finest(m, nullptr);
  fit.m = m;
  return fit;
}

}  // namespace ltcfit
