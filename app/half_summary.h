// What rounding to halves did to a table, for people.
#pragma once

#include "export/packing.h"

namespace ltcfit::app {

/// Prints one line, and the `worst` nodes that it moves most with their errors. Nothing for a table of
/// floats.
void printHalfSummary(const Table& table, const HalfReport& report, int worst);

}  // namespace ltcfit::app
