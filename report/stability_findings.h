// What the rows of a stability run say together.
#pragma once

#include <vector>

#include "report/stability.h"

namespace ltcfit {

/// The failures that the papers tell of, with how often they show, and what the other fitters do from the
/// same starts. Only of fitters that ran.
std::vector<StabilityFinding> stabilityFindings(const std::vector<StabilityRow>& rows);

}  // namespace ltcfit
