// What rounding to halves did to a table, for people.
#pragma once

#include <string>

#include "export/half_table.h"

namespace ltcfit::app {

/// One line, and one for each of the `worst` nodes that it moves most, with their errors. Empty for a table
/// of floats.
std::string halfSummary(const Table& table, const HalfReport& report, int worst);

}  // namespace ltcfit::app
