// A table at other nodes.
#pragma once

#include <vector>

#include "ltc/table.h"

namespace ltcfit {

/// The parameters that an axis of a table answers for, physical units. Ends that are those of the parameter
/// itself, 0, 1 or 90 degrees, up to the rounding of files or the clamping of a fit (the alpha floor, a
/// grazing angle), are exactly these.
struct AxisReach {
  double low = 0.0;
  double high = 0.0;
};
AxisReach reachOf(const TableInfo& info, std::size_t axis);

/// The table looked up at the texels of other axes of the same kind, stored as before (M or its inverse,
/// scaled alike). Between nodes it carries the interpolation error of the source; a new fit does not. Throws
/// Refusal where a look-up has no inverse, for axes of another kind, and for an axis that goes
/// beyond the table's own.
Table resampled(const Table& table, std::vector<Axis> axes);

}  // namespace ltcfit
