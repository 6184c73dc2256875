// How a Ceres solver ended, in the terms of all optimizers. Internal to fit/.
#pragma once

#include <ceres/types.h>

#include "fit/optimizer.h"

namespace ltcfit::internal {

inline Termination terminationOf(ceres::TerminationType type) {
  if (type == ceres::CONVERGENCE) return Termination::kConverged;
  return type == ceres::NO_CONVERGENCE ? Termination::kMaxEvaluations : Termination::kFailure;
}

}  // namespace ltcfit::internal
