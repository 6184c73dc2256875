#include "export/c_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace ltcfit {

std::string identifier(const std::string& text) {
  std::string out;
  for (char c : text) out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (out.empty() || std::isalpha(static_cast<unsigned char>(out[0])) == 0) out.insert(0, "ltc_");
  return out;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); });
  return text;
}

std::string commentSafe(std::string text) {
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = ' ';
  }
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    const bool star = (text[i] == '*' && text[i + 1] == '/') || (text[i] == '/' && text[i + 1] == '*');
    if (star) text[i + 1] = ' ';
  }
  return text;
}

std::string axisFormula(const Axis& axis) {
  const std::string& v = axis.name;
  const bool full = axis.low == 0.0;
  switch (axis.map) {
    case AxisMap::kSqrt:
      if (full && axis.high == 1.0) return fmt::format("sqrt({})", v);
      return fmt::format("(sqrt({}) - {:.9g}) / {:.9g}", v, std::sqrt(axis.low),
                         std::sqrt(axis.high) - std::sqrt(axis.low));
    case AxisMap::kSqrtOneMinusCos:
      if (full && mapCoordinate(axis.map, axis.high) > 0.999999) return "sqrt(1 - N.V), N.V = cos theta";
      return fmt::format("(sqrt(1 - N.V) - {:.9g}) / {:.9g}", mapCoordinate(axis.map, axis.low),
                         mapCoordinate(axis.map, axis.high) - mapCoordinate(axis.map, axis.low));
    case AxisMap::kLinear:
      if (full) return axis.high == 1.0 ? v : fmt::format("{} / {:.9g}", v, axis.high);
      return fmt::format("({} - {:.9g}) / {:.9g}", v, axis.low, axis.high - axis.low);
    case AxisMap::kNone:
      break;
  }
  return "search the node values below";
}

std::string valuesComment(const Axis& axis) {
  std::string out;
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    out += i % 8 == 0 ? "\n *     " : " ";
    out += fmt::format("{:.9g}", axis.values[i]);
  }
  return out;
}

}  // namespace ltcfit
