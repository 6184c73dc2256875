// The interface between objectives and optimizers.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace ltcfit {

/// Why an optimizer stopped. Not converging is a result, not an error.
enum class Termination {
  kConverged,       ///< the tolerance on cost or parameters was met
  kMaxEvaluations,  ///< the budget was used up first
  kFailure,         ///< the optimizer gave up, or the cost at the start was not finite
};
/// "converged", "max-evaluations" or "failure".
std::string_view terminationName(Termination termination);

/// A cost of n parameters. A value that is not finite is taken as very bad, never as a minimum.
using CostFunction = std::function<double(std::span<const double>)>;

struct OptimizerResult {
  std::vector<double> parameters;  ///< the best found, or the start where nothing better was
  double startCost = 0.0;
  double cost = 0.0;
  int evaluations = 0;
  Termination termination = Termination::kFailure;
};

}  // namespace ltcfit
