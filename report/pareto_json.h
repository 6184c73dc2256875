// The JSON of `ltcfit pareto`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "report/pareto.h"

namespace ltcfit {

/// Format "ltcfit-pareto", version 1. Figures have five significant digits; those that are not finite are
/// null. `command` makes the same errors again.
nlohmann::ordered_json paretoToJson(const ParetoOptions& options, const ParetoResult& result,
                                    const std::string& command);

}  // namespace ltcfit
