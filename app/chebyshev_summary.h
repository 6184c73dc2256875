// What the Chebyshev form of a table loses, in words.
#pragma once

#include <string>

#include "ltc/chebyshev_fit.h"

namespace ltcfit::app {

/// A line on how far the form is from the table at its nodes. `expanded` is the form's own table; `measured`:
/// also the errors of both against the lobes, off-grid, as `ltcfit score` has them.
std::string chebyshevSummary(const Table& table, const Table& expanded, const ChebyshevDifference& difference,
                             bool measured);

}  // namespace ltcfit::app
