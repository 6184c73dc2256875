// What rounding to halves did to a table, for people.
#pragma once

#include <cstdio>

#include "export/half_table.h"

namespace ltcfit::app {

/// Prints to `out` one line, and the `worst` nodes that it moves most with their errors. Nothing for a table
/// of floats.
void printHalfSummary(std::FILE* out, const Table& table, const HalfReport& report, int worst);

}  // namespace ltcfit::app
