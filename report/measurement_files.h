// Results of other commands that a report takes in.
#pragma once

#include <string>
#include <string_view>

#include "export/json_fields.h"

namespace ltcfit {

/// Largest file taken: some twenty times what the commands write.
inline constexpr std::size_t kMeasurementBytes = std::size_t{16} << 20;

/// The JSON that `ltcfit pareto` or `ltcfit stability` wrote, every field that the page reads checked for its
/// type, its range and its references, and fields against one another, so that the page cannot fail on it:
/// processor times within 1e-9..1e6 s, ratios to the best known error null or within 0..1e30, low <= middle
/// <= high, and rows that pass exactly where they break no limit. Fields that are not known stay. Throws
/// InputError naming `name` and the field.
Json paretoFromJson(std::string_view text, const std::string& name);
Json stabilityFromJson(std::string_view text, const std::string& name);

}  // namespace ltcfit
