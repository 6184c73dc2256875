#include "report/objective_probe.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "fit/l3_objective.h"
#include "fit/sliced_wasserstein.h"
#include "ggx/random.h"
#include "ltc/ltc.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Steps of the Hessians' differences. The distances are only piecewise smooth: hence wide, as in the fit's
// own Hessian (fit/sliced_wasserstein_fit.cpp).
constexpr double kHessianStep = 0.05;
constexpr double kCostStep = 0.02;
// Gradients are compared beside the matrix, where they do not vanish.
constexpr double kAside = 0.05;
// Steps of the gradients' check: the cells of ProjectedCdfLoss are piecewise linear and hold float32
// projections; the others are smooth down to where the condition of M leaves digits, which for needles of
// 100:1 is sooner than for others. A wrong derivative is wrong at every step, so the smallest error counts.
constexpr std::array<double, 4> kCellSteps{5e-4, 2e-3, 1e-2, 5e-2};
constexpr std::array<double, 4> kFineSteps{1e-4, 1e-5, 1e-6, 1e-7};
constexpr int kSortedSamples = 2048;
constexpr int kSortedSlices = 64;

Matrix3d matrixAt(const Matrix3d& base, MatrixFamily family, const VectorXd& p) {
  return changedBy(base, family, {p.data(), static_cast<std::size_t>(p.size())});
}

// From d cost / d M at M = base (I + P) to the derivatives by p.
VectorXd toParameters(const Matrix3d& base, MatrixFamily family, const Matrix3d& gradient) {
  const std::vector<Matrix3d>& basis = familyBasis(family);
  const Matrix3d relative = base.transpose() * gradient;
  VectorXd g(static_cast<Eigen::Index>(basis.size()));
  for (Eigen::Index k = 0; k < g.size(); ++k)
    g[k] = relative.cwiseProduct(basis[static_cast<std::size_t>(k)]).sum();
  return g;
}

VectorXd aside(Eigen::Index n) {
  VectorXd p(n);
  for (Eigen::Index k = 0; k < n; ++k) p[k] = k % 2 == 0 ? kAside : -kAside;
  return p;
}

MatrixXd hessianOf(const GradientFunction& cost, Eigen::Index n) {
  MatrixXd hessian(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    VectorXd above, below;
    cost(kHessianStep * VectorXd::Unit(n, k), &above);
    cost(-kHessianStep * VectorXd::Unit(n, k), &below);
    hessian.col(k) = (above - below) / (2.0 * kHessianStep);
  }
  return hessian;
}

ObjectiveProbe probeGradient(const GradientFunction& cost, MatrixFamily family, const Matrix3d& m,
                             std::span<const double> steps) {
  const auto n = static_cast<Eigen::Index>(familyBasis(family).size());
  const MatrixXd hessian = hessianOf(cost, n);
  return {conditionOf(hessian, n), rawCondition(hessian, family, m), gradientErrorOf(cost, aside(n), steps)};
}

ObjectiveProbe probeCells(const LobeFitTarget& target, const Matrix3d& m, const LobeFitOptions& options) {
  const MatrixFamily family = target.family();
  ProjectedCdfLoss loss = makeLoss(target.samples(), options.sw.levels.back(), options.sw.seed);
  return probeGradient(
      [&](const VectorXd& p, VectorXd* g) {
        Matrix3d gradient;
        const double value = loss(matrixAt(m, family, p), g != nullptr ? &gradient : nullptr);
        if (g != nullptr) *g = toParameters(m, family, gradient);
        return value;
      },
      family, m, kCellSteps);
}

ObjectiveProbe probeSorted(const LobeFitTarget& target, const Matrix3d& m, const LobeFitOptions& options) {
  const MatrixFamily family = target.family();
  Random random(mixSeed(options.sgd.seed, 60));
  const std::vector<Eigen::Vector3d> lobe = rejectionSamples(target.lobe(), kSortedSamples, random);
  const std::vector<Eigen::Vector3d> slices = familySlices(MatrixFamily::kGeneral, kSortedSlices);
  const R2Sequence points(mixSeed(options.sgd.seed, 61));
  std::vector<Eigen::Vector3d> cosine;
  for (std::uint64_t i = 0; i < lobe.size(); ++i) cosine.push_back(sampleCosine(points(i)));
  SlicedWasserstein loss;
  loss.setTarget(lobe, slices);
  return probeGradient(
      [&](const VectorXd& p, VectorXd* g) {
        Matrix3d gradient;
        const double value =
            loss.evaluate(matrixAt(m, family, p), cosine, g != nullptr ? &gradient : nullptr);
        if (g != nullptr) *g = toParameters(m, family, gradient);
        return value;
      },
      family, m, kFineSteps);
}

ObjectiveProbe probeLights(const LobeFitTarget& target, const Matrix3d& m, const LobeFitOptions& options) {
  const MatrixFamily family = target.family();
  const ContourIntegrator truth(target.lobe());
  const LightTarget about{truth, target.moments().albedo, family, target.momentStart()};
  const PolygonLights lights = makePolygonLights(truth, about.albedo, m, options.light.lights);
  const LightProblem problem = makeLightProblem(lights.lights, about, m, options.light);
  const auto n = static_cast<Eigen::Index>(familyBasis(family).size());
  const auto rows = static_cast<Eigen::Index>(problem.residualCount());
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto evaluate = [&](const VectorXd& p, RowMajor* jacobian) {
    VectorXd residuals(rows);
    if (jacobian != nullptr) jacobian->resize(rows, n);
    if (!problem.evaluate(m, p.data(), residuals.data(), jacobian != nullptr ? jacobian->data() : nullptr))
      residuals.setConstant(std::numeric_limits<double>::quiet_NaN());
    return residuals;
  };
  RowMajor jacobian;
  evaluate(VectorXd::Zero(n), &jacobian);
  const MatrixXd hessian = jacobian.transpose() * jacobian;
  const VectorXd at = aside(n);
  evaluate(at, &jacobian);
  double error = std::numeric_limits<double>::infinity();
  for (const double step : kFineSteps) {
    RowMajor difference(rows, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const VectorXd h = step * VectorXd::Unit(n, k);
      difference.col(k) = (evaluate(at + h, nullptr) - evaluate(at - h, nullptr)) / (2.0 * step);
    }
    error = std::min(error, (jacobian - difference).norm() / difference.norm());
  }
  return {conditionOf(hessian, n), rawCondition(hessian, family, m), error};
}

ObjectiveProbe probeL3(const LobeFitTarget& target, const Matrix3d& m, const LobeFitOptions& options) {
  const MatrixFamily family = target.family();
  const L3Objective objective(target.lobe(), target.moments().albedo, options.l3.samples, options.l3.seed);
  const auto n = static_cast<Eigen::Index>(familyBasis(family).size());
  const auto cost = [&](const VectorXd& p) { return objective(matrixAt(m, family, p)); };
  MatrixXd hessian(n, n);
  const double h = kCostStep;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const VectorXd a = h * VectorXd::Unit(n, i);
      const VectorXd b = h * VectorXd::Unit(n, j);
      hessian(i, j) = hessian(j, i) =
          (cost(a + b) - cost(a - b) - cost(b - a) + cost(-a - b)) / (4.0 * h * h);
    }
  }
  return {conditionOf(hessian, n), rawCondition(hessian, family, m), std::nullopt};
}

}  // namespace

double gradientErrorOf(const GradientFunction& cost, const VectorXd& at, std::span<const double> steps) {
  VectorXd given;
  cost(at, &given);
  double least = std::numeric_limits<double>::infinity();
  for (const double step : steps) {
    VectorXd difference(at.size());
    for (Eigen::Index k = 0; k < at.size(); ++k) {
      const VectorXd h = step * VectorXd::Unit(at.size(), k);
      difference[k] = (cost(at + h, nullptr) - cost(at - h, nullptr)) / (2.0 * step);
    }
    least = std::min(least, (given - difference).norm() / difference.norm());
  }
  return least;
}

double conditionOf(const MatrixXd& hessian, Eigen::Index n) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(0.5 * (hessian + hessian.transpose()),
                                                       Eigen::EigenvaluesOnly);
  std::vector<double> values;
  for (const double v : solver.eigenvalues()) values.push_back(std::abs(v));
  std::sort(values.rbegin(), values.rend());
  const double least = values[static_cast<std::size_t>(n) - 1];
  return least > 0.0 ? values[0] / least : std::numeric_limits<double>::infinity();
}

double conditionOf(const Matrix3d& m) {
  const Eigen::Vector3d values = Eigen::JacobiSVD<MatrixXd>(m).singularValues();
  return values[0] / values[2];
}

double rawCondition(const MatrixXd& hessian, MatrixFamily family, const Matrix3d& base) {
  const std::vector<Matrix3d>& basis = familyBasis(family);
  const auto n = static_cast<Eigen::Index>(basis.size());
  const Matrix3d inverse = (base / base.col(2).norm()).inverse();
  MatrixXd change(n, 9);  // of p by each entry
  for (Eigen::Index k = 0; k < n; ++k) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        Matrix3d entry = Matrix3d::Zero();
        entry(r, c) = 1.0;
        change(k, 3 * r + c) = (inverse * entry).cwiseProduct(basis[static_cast<std::size_t>(k)]).sum();
      }
    }
  }
  return conditionOf(MatrixXd(change.transpose() * hessian * change), n);
}

ObjectiveProbe probeObjective(const LobeFitTarget& target, const Matrix3d& m, const LobeFitOptions& options) {
  switch (options.fitter) {
    case Fitter::kSlicedWasserstein:
      return probeCells(target, m, options);
    case Fitter::kSlicedWassersteinSgd:
      return probeSorted(target, m, options);
    case Fitter::kL3:
      return probeL3(target, m, options);
    case Fitter::kLight:
      break;
  }
  return probeLights(target, m, options);
}

}  // namespace ltcfit
