// Numbers in the JSON of reports.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace ltcfit {

/// 5 significant digits; null for what is not finite.
nlohmann::ordered_json figure(double value);

}  // namespace ltcfit
