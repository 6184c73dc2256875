// The result of a stability run as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "report/stability.h"

namespace ltcfit {

/// "ltcfit-stability", version 1 (README, Stability). Figures with 5 significant digits; what is not finite
/// is null. `command` is written as given.
nlohmann::ordered_json stabilityJson(const StabilityResult& result, const StabilityOptions& options,
                                     const std::string& set, const std::string& command);

}  // namespace ltcfit
