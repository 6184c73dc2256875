#include "app/axes_argument.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "base/refusal.h"
#include "export/atomic_file.h"

namespace ltcfit::app {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& what) {
  throw InputError(fmt::format("--axes '{}': {}", text, what));
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return parts;
}

double number(const std::string& text, const std::string& whole) {
  double v = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(v))
    refuse(whole, fmt::format("'{}' is not a number", text));
  return v;
}

// What follows the "=".
NodePlacement placement(std::string_view axis, const std::string& text, const std::string& whole) {
  const std::vector<std::string> parts = split(text, ':');
  NodePlacement out;
  if (parts[0] == "knots") {
    const bool angle = axis == "theta" || axis == "phi";
    out.map = AxisMap::kNone;
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const double v = number(parts[i], whole);
      // 90 degrees are exactly pi/2
      out.knots.push_back(angle ? v / 90.0 * (0.5 * std::numbers::pi) : v);
    }
    return out;
  }
  try {
    out.map = axisMapFromName(parts[0]);
  } catch (const Refusal&) {
    refuse(whole,
           fmt::format("'{}' is none of the maps linear, sqrt, sqrt-one-minus-cos and knots", parts[0]));
  }
  if (parts.size() > 3) refuse(whole, fmt::format("{} has more than two coefficients", text));
  for (std::size_t i = 1; i < parts.size(); ++i) out.warp[i - 1] = number(parts[i], whole);
  return out;
}

// Replaces those of `axes` that the list names.
void parseList(const std::string& text, std::span<const std::string_view> names, const char* presets,
               std::span<NodePlacement> axes) {
  std::vector<bool> given(names.size());
  for (const std::string& item : split(text, ',')) {
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos)
      refuse(text, fmt::format("'{}' is neither {} nor AXIS=MAP", item, presets));
    const std::string name = item.substr(0, equals);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) refuse(text, fmt::format("no axis '{}' ({})", name, fmt::join(names, ", ")));
    const auto axis = static_cast<std::size_t>(found - names.begin());
    if (given[axis]) refuse(text, fmt::format("{} is given twice", name));
    given[axis] = true;
    axes[axis] = placement(name, item.substr(equals + 1), text);
  }
}

}  // namespace

IsotropicPlacement parseIsotropicAxes(const std::string& text) {
  if (text == "2016" || text == "2017" || text == "best") return isotropicPlacement(text);
  IsotropicPlacement axes = isotropicPlacement(kIsotropicAxes);
  parseList(text, kIsotropicAxisNames, "2016, 2017, best", axes);
  return axes;
}

AnisotropicPlacement parseAnisotropicAxes(const std::string& text) {
  if (text == "2022" || text == "best") return anisotropicPlacement(text);
  AnisotropicPlacement axes = anisotropicPlacement(kAnisotropicAxes);
  parseList(text, kAnisotropicAxisNames, "2022, best", axes);
  return axes;
}

}  // namespace ltcfit::app
