// JSON that people write, with messages that help them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace ltcfit {

/// Parses JSON. InputError for what is not JSON, with the byte (NaN and Infinity, which some writers allow
/// themselves, by name), for a zero byte, and for numbers beyond the range of double.
nlohmann::json parseJsonText(std::string_view text);

}  // namespace ltcfit
