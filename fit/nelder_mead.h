// Nelder-Mead simplex descent, through NLopt.
#pragma once

#include <string>

#include "fit/optimizer.h"

namespace ltcfit {

struct NelderMeadOptions {
  int maxEvaluations = 1000;
  /// Stop when the simplex' costs agree to this fraction, or its corners to parameterTolerance.
  double relativeCostTolerance = 1e-7;
  double parameterTolerance = 1e-5;

  /// False with the reason in `error` for values that make no sense.
  bool isValid(std::string* error) const;
};

/// Minimises `cost` from `start` with a first simplex of the given edge lengths (one for each parameter, not
/// 0). Deterministic. Empty or unequal spans are a caller's bug and abort.
OptimizerResult minimizeNelderMead(const CostFunction& cost, std::span<const double> start,
                                   std::span<const double> steps, const NelderMeadOptions& options);

}  // namespace ltcfit
