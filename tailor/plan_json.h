// The plan's file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "tailor/scene_plan.h"

namespace ltcfit {

/// JSON, format "ltc-plan", version 1. What `ltcfit fit --plan` reads of it are the fields `scene`,
/// `request`, `lights` and of each table `kind`, `max_error`, `max_bytes` and `distribution` (lobes as
/// [alpha_x, alpha_y, f0, f90, weight]): they may be edited. All else says what is expected and why.
std::string planToJson(const ScenePlan& plan);

/// Largest plan that planFromJson reads, and the memory that its JSON may take.
inline constexpr std::size_t kMaxPlanBytes = std::size_t{1} << 28;
inline constexpr std::size_t kMaxPlanMemory = std::size_t{1} << 31;

/// Reads those fields; of the tables distribution, maxError and maxBytes alone are set. `name` is the file's,
/// for messages. Throws InputError naming the field: not JSON, another format or version, a missing or wrong
/// field, a value out of range, more than 65536 lobes; and, before it is parsed, for more than kMaxPlanBytes
/// or kMaxPlanMemory, with the number of bytes.
ScenePlan planFromJson(std::string_view text, const std::string& name);

}  // namespace ltcfit
