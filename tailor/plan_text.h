// The plan, for people.
#pragma once

#include <string>

#include "tailor/scene_plan.h"

namespace ltcfit {

/// Some twenty lines: materials, tables with sizes and reasons, shading, notes. Ends with a line break.
std::string planText(const ScenePlan& plan);

/// "0.3 to 0.7", or "0.3" where both are the same to three digits.
std::string rangeText(double low, double high);
/// "1.2 KB", "960 bytes".
std::string bytesText(std::size_t bytes);
/// "15 x 6".
std::string nodesText(const std::vector<std::size_t>& nodes);

}  // namespace ltcfit
