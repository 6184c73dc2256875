// The options that say how finely errors are measured, in every command that measures.
#pragma once

#include <CLI/CLI.hpp>

#include "report/metrics.h"

namespace ltcfit::app {

/// Adds --samples, --directions, --quads and --lights.
void addMetricOptions(CLI::App& command, MetricOptions& metrics);

}  // namespace ltcfit::app
