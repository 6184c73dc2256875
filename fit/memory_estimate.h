// How much memory fits take: to refuse, before the work, what a machine does not have.
#pragma once

#include <cstddef>

#include "fit/lobe_fit.h"

namespace ltcfit {

/// Estimated bytes that the fit of one lobe holds at its peak, beside the program itself. Within a factor of
/// 1.5 where they are more than some 20 MB (tests/app/memory.sh).
double lobeFitBytes(const LobeFitOptions& options, TableKind kind);

/// The same of the plan, the results and the written table of one node, for tables of many nodes.
double nodeFitBytes(TableKind kind);

/// The same of joint refinement with the default LookUpLossOptions, over `points` look-ups between nodes and
/// one for each node.
double refinementBytes(std::size_t points, std::size_t nodes);

}  // namespace ltcfit
