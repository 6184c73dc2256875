// A table at other nodes.
#pragma once

#include <vector>

#include "ltc/table.h"

namespace ltcfit {

/// The table looked up at the texels of other axes of the same kind, stored as before (M or its inverse,
/// scaled alike). Between nodes it carries the interpolation error of the source; a new fit does not. Throws
/// std::invalid_argument where a look-up has no inverse, or for axes of another kind.
Table resampled(const Table& table, std::vector<Axis> axes);

}  // namespace ltcfit
