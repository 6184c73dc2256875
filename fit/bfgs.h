// Quasi-Newton descent (BFGS with a Wolfe line search), through Ceres.
#pragma once

#include <functional>
#include <string>

#include "fit/optimizer.h"

namespace ltcfit {

/// A cost of n parameters with its gradient (n values, null where only the cost is wanted). A value that is
/// not finite makes the line search step back.
using GradientCostFunction = std::function<double(std::span<const double>, double* gradient)>;

struct BfgsOptions {
  int maxIterations = 50;
  /// Stop when an iteration lowers the cost by less than this fraction.
  double relativeCostTolerance = 1e-5;

  /// False with the reason in `error` for values that make no sense.
  bool isValid(std::string* error) const;
};

/// Minimises `cost` from `start`. Parameters should be scaled so that steps of 0.1 matter and the curvature
/// is of order 1: the first step is steepest descent. Deterministic. An empty start is a caller's bug and
/// aborts.
OptimizerResult minimizeBfgs(const GradientCostFunction& cost, std::span<const double> start,
                             const BfgsOptions& options);

}  // namespace ltcfit
