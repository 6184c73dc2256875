#include "fit/light_fit.h"

#include <ceres/ceres.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/refusal.h"
#include "fit/ceres_termination.h"
#include "ltc/ltc.h"
#include "ltc/polygon.h"

namespace ltcfit {

using Eigen::Matrix3d;
using Eigen::RowVector3d;

namespace {

// Lights of the first round, which only has to aim those of the second.
constexpr int kFirstLights = 64;
// What the first round finds decides where the lights of the second lie: two descents into one minimum must
// end in the same digits. Takes 1.5 % of the time of the 64^2 table more than 1e-4.
constexpr double kAimTolerance = 1e-9;
// Few lights can prefer a minimum that all lights do not: less of a gain than this is none.
constexpr double kAimGain = 0.1;
// A descent that ends so much above the other one has not arrived.
constexpr double kArrivedCost = 1.01;
// See makeLightProblem. What lights see at all has a curvature some hundred times larger.
constexpr double kPriorShare = 0.1;

class Residuals final : public ceres::CostFunction {
 public:
  Residuals(const LightProblem& problem, const Matrix3d& base, int& evaluations)
      : problem_(problem), base_(base), evaluations_(evaluations) {
    set_num_residuals(static_cast<int>(problem.residualCount()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(familyBasis(problem.family).size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    ++evaluations_;
    return problem_.evaluate(base_, parameters[0], residuals, jacobians != nullptr ? jacobians[0] : nullptr);
  }

 private:
  const LightProblem& problem_;
  Matrix3d base_;
  int& evaluations_;
};

Matrix3d scaled(const Matrix3d& m) {
  Matrix3d out = m / m.col(2).norm();
  if (out.determinant() < 0.0) out.col(1) *= -1.0;
  return out;
}

}  // namespace

bool LightFitOptions::isValid(std::string* error) const {
  if (!lights.isValid(error)) return false;
  if (!(leakWeight >= 0.0 && leakWeight <= 100.0)) {
    *error = "leak weight " + std::to_string(leakWeight) + ", must be in 0..100";
    return false;
  }
  if (maxIterations < 1 || !(relativeCostTolerance > 0.0 && relativeCostTolerance < 1.0)) {
    *error = "maxIterations must be at least 1, relativeCostTolerance in (0, 1)";
    return false;
  }
  return true;
}

LightFitOptions lightFitPreset(std::string_view name) {
  LightFitOptions o;
  if (name == "fast") {
    o.lights.lights = 256;
  } else if (name == "fine") {
    o.lights.lights = 8192;
  } else if (name != "standard") {
    throw Refusal("preset '" + std::string(name) + "' (fast, standard or fine)");
  }
  return o;
}

bool LightProblem::evaluate(const Matrix3d& base, const double* p, double* residuals,
                            double* jacobian) const {
  const std::vector<Matrix3d>& basis = familyBasis(family);
  const std::size_t count = basis.size();
  Matrix3d change = Matrix3d::Identity();
  for (std::size_t k = 0; k < count; ++k) change += p[k] * basis[k];
  const Matrix3d m = base * change;
  if (!(m.determinant() > 0.0) || !m.inverse().allFinite()) return false;
  const Ltc ltc(m);
  const RowVector3d v = m.row(2);
  const double length = v.norm();
  // 2 |v| cos(psi / 2) = sqrt(2 |v| (|v| + v.z))
  const double scale = leak / std::sqrt(2.0 * length * (length + v.z()));
  if (!std::isfinite(scale)) return false;  // the whole lobe below the horizon
  double* const last = residuals + lights->size();
  last[0] = scale * v.x();
  last[1] = scale * v.y();
  const Matrix3d q = prior > 0.0 ? Matrix3d(reference.inverse() * m) : Matrix3d(Matrix3d::Identity());
  const double unit = q.trace() / 3.0;
  if (!(unit > 0.0)) return false;
  for (std::size_t k = 0; k < count; ++k) last[2 + k] = prior * q.cwiseProduct(basis[k]).sum() / unit;
  if (jacobian == nullptr) {
    for (std::size_t j = 0; j < lights->size(); ++j) {
      const IntegratedLight& l = (*lights)[j];
      residuals[j] = l.weight * (ltcPolygonIntegral(ltc, l.quad) - l.integral);
    }
    return true;
  }
  // a step dp changes m = base (I + P) to m (I + (I + P)^-1 dP)
  std::array<Matrix3d, 9> relative;
  const Matrix3d inverse = change.inverse();
  for (std::size_t k = 0; k < count; ++k) relative[k] = inverse * basis[k];
  double* row = jacobian;
  for (std::size_t j = 0; j < lights->size(); ++j) {
    const IntegratedLight& l = (*lights)[j];
    Matrix3d gradient;
    residuals[j] = l.weight * (ltcPolygonIntegral(ltc, l.quad, &gradient) - l.integral);
    for (std::size_t k = 0; k < count; ++k) *row++ = l.weight * gradient.cwiseProduct(relative[k]).sum();
  }
  for (std::size_t k = 0; k < count; ++k) {
    const RowVector3d dv = v * relative[k];
    const double dl = v.dot(dv) / length;
    const double ds = -0.5 * scale * (dl / length + (dl + dv.z()) / (length + v.z()));
    row[k] = scale * dv.x() + ds * v.x();
    row[count + k] = scale * dv.y() + ds * v.y();
  }
  row += 2 * count;
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t k = 0; k < count; ++k) {
      const Matrix3d dq = q * relative[k];
      *row++ = prior > 0.0 ? prior / unit * (dq - dq.trace() / (3.0 * unit) * q).cwiseProduct(basis[j]).sum()
                           : 0.0;
    }
  }
  return true;
}

double LightProblem::cost(const Matrix3d& m) const {
  const std::vector<double> zero(familyBasis(family).size(), 0.0);
  std::vector<double> residuals(residualCount());
  if (!evaluate(m, zero.data(), residuals.data(), nullptr)) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const double r : residuals) sum += r * r;
  return 0.5 * sum;
}

LightProblem makeLightProblem(const std::vector<IntegratedLight>& lights, const LightTarget& target,
                              const Matrix3d& near, const LightFitOptions& options) {
  LightProblem problem{.lights = &lights, .family = target.family};
  const double n = static_cast<double>(lights.size());
  const double error = std::sqrt(2.0 * problem.cost(near) / n);
  problem.leak = std::sqrt(options.leakWeight * n * error);
  problem.prior = error * std::sqrt(kPriorShare * n);
  problem.reference = target.momentStart;
  return problem;
}

LightFit solveLightProblem(const LightProblem& problem, const Matrix3d& start,
                           const LightFitOptions& options) {
  LightFit fit;
  fit.m = scaled(start);
  fit.startCost = fit.cost = problem.cost(fit.m);
  fit.evaluations = 1;
  if (!std::isfinite(fit.startCost)) return fit;
  std::vector<double> p(familyBasis(problem.family).size(), 0.0);
  ceres::Problem ceresProblem;
  ceresProblem.AddResidualBlock(new Residuals(problem, fit.m, fit.evaluations), nullptr, p.data());
  ceres::Solver::Options o;
  o.linear_solver_type = ceres::DENSE_QR;
  o.logging_type = ceres::SILENT;
  o.num_threads = 1;
  o.max_num_iterations = options.maxIterations;
  o.function_tolerance = options.relativeCostTolerance;
  ceres::Solver::Summary summary;
  ceres::Solve(o, &ceresProblem, &summary);
  fit.startCost = summary.initial_cost;
  fit.cost = summary.final_cost;
  fit.termination = internal::terminationOf(summary.termination_type);
  const Matrix3d m = changedBy(fit.m, problem.family, p);
  if (m.allFinite() && fit.cost <= fit.startCost) {
    fit.m = scaled(m);
  } else {
    fit.cost = fit.startCost;
    fit.termination = Termination::kFailure;
  }
  return fit;
}

LightFit fitLights(const LightTarget& given, const Matrix3d& start, const LightFitOptions& options) {
  LightTarget target = given;
  target.momentStart = scaled(given.momentStart);
  PolygonLightOptions few = options.lights;
  few.lights = std::min(kFirstLights, few.lights);
  const PolygonLights first = makePolygonLights(target.truth, target.albedo, target.momentStart, few);
  const LightProblem aiming = makeLightProblem(first.lights, target, target.momentStart, options);
  LightFitOptions toTheEnd = options;
  toTheEnd.relativeCostTolerance = std::min(kAimTolerance, options.relativeCostTolerance);
  LightFit aimed = solveLightProblem(aiming, target.momentStart, toTheEnd);
  int evaluations = aimed.evaluations;
  bool restarted = false;
  if (const Matrix3d other = scaled(start); other != target.momentStart) {
    const LightFit fit = solveLightProblem(aiming, other, toTheEnd);
    evaluations += fit.evaluations;
    restarted = !(fit.cost <= kArrivedCost * aimed.cost);
    if (fit.cost < (1.0 - kAimGain) * aimed.cost) aimed = fit;
  }

  const PolygonLights all = makePolygonLights(target.truth, target.albedo, aimed.m, options.lights);
  const LightProblem problem = makeLightProblem(all.lights, target, aimed.m, options);
  LightFit out = solveLightProblem(problem, aimed.m, options);
  out.evaluations += evaluations;
  out.restarted = restarted;
  out.integralError = all.integralError;
  return out;
}

}  // namespace ltcfit
