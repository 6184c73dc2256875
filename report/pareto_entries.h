// What `ltcfit pareto` fits: lobes over the whole range of a kind of table.
#pragma once

#include <cstddef>
#include <vector>

#include "fit/lobe_fit.h"
#include "ltc/table.h"

namespace ltcfit {

/// `count` >= 1 entries, the same for every run. Each of these is taken in `count` equal steps from end to
/// end, in orders that spread the entries, and the first few of them, over all combinations:
/// anisotropic: sqrt(alpha_x) in 0.1..1, sqrt(alpha_y / alpha_x) in 0.1..1, theta and phi in 0..90 degrees;
/// isotropic: sqrt(alpha) in 0.05..1 and theta. A single entry has the middle of each.
std::vector<LobeParameters> paretoEntries(TableKind kind, std::size_t count);

}  // namespace ltcfit
