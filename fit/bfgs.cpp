#include "fit/bfgs.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <cmath>

#include "base/diagnostics.h"
#include "fit/ceres_termination.h"

namespace ltcfit {
namespace {

class Adapter final : public ceres::FirstOrderFunction {
 public:
  Adapter(const GradientCostFunction& cost, std::size_t size, int& evaluations)
      : cost_(cost), size_(size), evaluations_(evaluations) {}

  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    ++evaluations_;
    *cost = cost_({parameters, size_}, gradient);
    return std::isfinite(*cost);
  }
  int NumParameters() const override { return static_cast<int>(size_); }

 private:
  const GradientCostFunction& cost_;
  std::size_t size_;
  int& evaluations_;
};

}  // namespace

bool BfgsOptions::isValid(std::string* error) const {
  if (maxIterations < 1) {
    *error = "maxIterations = " + std::to_string(maxIterations) + ", must be at least 1";
    return false;
  }
  if (!(relativeCostTolerance > 0.0 && relativeCostTolerance < 1.0)) {
    *error = "relativeCostTolerance = " + std::to_string(relativeCostTolerance) + ", must be in (0, 1)";
    return false;
  }
  return true;
}

OptimizerResult minimizeBfgs(const GradientCostFunction& cost, std::span<const double> start,
                             const BfgsOptions& options) {
  if (start.empty()) abortWith("minimizeBfgs: no parameters");
  OptimizerResult result;
  result.parameters.assign(start.begin(), start.end());
  result.startCost = result.cost = cost(start, nullptr);
  result.evaluations = 1;
  if (!std::isfinite(result.startCost)) return result;

  const ceres::GradientProblem problem(new Adapter(cost, start.size(), result.evaluations));
  ceres::GradientProblemSolver::Options ceresOptions;
  ceresOptions.line_search_direction_type = ceres::BFGS;
  ceresOptions.use_approximate_eigenvalue_bfgs_scaling = true;
  ceresOptions.logging_type = ceres::SILENT;
  ceresOptions.max_num_iterations = options.maxIterations;
  ceresOptions.function_tolerance = options.relativeCostTolerance;
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(ceresOptions, problem, result.parameters.data(), &summary);
  result.cost = summary.final_cost;
  result.termination = internal::terminationOf(summary.termination_type);
  if (!(result.cost <= result.startCost)) {
    result.parameters.assign(start.begin(), start.end());
    result.cost = result.startCost;
  }
  return result;
}

}  // namespace ltcfit
