#include "export/chebyshev_file.h"

#include <fmt/format.h>

#include <cmath>

#include "export/atomic_file.h"
#include "export/json_fields.h"
#include "export/little_endian.h"

namespace ltcfit {
namespace {

constexpr const char* kChebyshevFormat = "ltc-chebyshev";
constexpr int kChebyshevVersion = 1;
constexpr double kLargestHalf = 65504.0;

ChebyshevForm readForm(const Json& json) {
  const JsonFields file(json, "");
  if (file.text("format") != kChebyshevFormat)
    throw InputError("format is not \"" + std::string(kChebyshevFormat) + "\"");
  const Json& version = file.get("version");
  if (!version.is_number_integer() || version != kChebyshevVersion)
    throw InputError(fmt::format("version {} is not known; this program reads version {}",
                                 version.is_number() ? version.dump() : std::string("of another type"),
                                 kChebyshevVersion));
  if (file.text("brdf") != "ggx") throw InputError("brdf '" + file.text("brdf") + "' is not known (ggx)");
  ChebyshevForm form;
  form.alphaFloor = file.number("alpha_floor");
  TableInfo origin;
  readOrigin(file, origin);
  form.provenance = std::move(origin.provenance);
  const JsonFields functions(file.get("functions"), "functions");
  for (std::size_t f = 0; f < kChebyshevFunctions; ++f) {
    const std::string name(chebyshevFunctionName(static_cast<ChebyshevFunction>(f)));
    for (const Json& numbers : functions.array(name.c_str())) {
      const std::string where = fmt::format("functions.{}[{}]", name, form.functions[f].size());
      if (!numbers.is_array()) throw InputError(where + " is not an array");
      std::vector<double> row;
      for (const Json& number : numbers) {
        if (!number.is_number()) throw InputError(fmt::format("{}[{}] is not a number", where, row.size()));
        // few digits: those that tell the float32 of the half from its neighbours
        const double given = number.get<double>();
        const bool inRange = std::abs(given) <= kLargestHalf;
        const double c = inRange ? roundToHalfPrecision(given) : 0.0;
        if (!inRange || static_cast<double>(static_cast<float>(given)) != c)
          throw InputError(fmt::format("{}[{}] = {} is not a half", where, row.size(), given));
        row.push_back(c);
      }
      form.functions[f].push_back(std::move(row));
    }
  }
  checkChebyshev(form);
  return form;
}

}  // namespace

double roundToHalfPrecision(double coefficient) {
  return static_cast<double>(halfValue(halfBits(static_cast<float>(coefficient))));
}

std::string chebyshevToJson(const ChebyshevForm& form, const ChebyshevDifference& difference) {
  std::string out = "{\n";
  const auto field = [&out](const char* key, const Json& value) {
    out += fmt::format("  \"{}\": {},\n", key, value.dump());
  };
  field("format", kChebyshevFormat);
  field("version", kChebyshevVersion);
  field("brdf", "ggx");
  field("alpha_floor", form.alphaFloor);
  field("variables", {{"x", "2 sqrt(alpha) - 1"},
                      {"s", "2 v - 1, v = cos(theta) (1 + 2 alpha) / (cos(theta) + 2 alpha)"}});
  field("coefficients", {{"count", form.coefficients()},
                         {"precision", "half"},
                         {"bytes", form.coefficients() * kCoefficientBytes},
                         {"order", "function: rows over T_j(s), each over T_i(x)"}});
  field("difference",
        {{"nodes", "alpha >= 0.002"},
         {"shift_over_spread", {{"mean", difference.meanShift}, {"max", difference.largestShift}}},
         {"norm", {{"mean", difference.meanNorm}, {"max", difference.largestNorm}}},
         {"fresnel", {{"mean", difference.meanFresnel}, {"max", difference.largestFresnel}}}});
  field("provenance", provenanceToJson(form.provenance));
  out += "  \"functions\": {";
  for (std::size_t f = 0; f < kChebyshevFunctions; ++f) {
    out += fmt::format("{}\n    \"{}\": [", f == 0 ? "" : ",",
                       chebyshevFunctionName(static_cast<ChebyshevFunction>(f)));
    const ChebyshevRows& rows = form.functions[f];
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const std::vector<float> row(rows[j].begin(), rows[j].end());
      out += fmt::format("{}\n      [{}]", j == 0 ? "" : ",", fmt::join(row, ", "));
    }
    out += "]";
  }
  return out + "\n  }\n}\n";
}

bool isChebyshevJson(std::string_view text) {
  if (text.find(kChebyshevFormat) == std::string_view::npos) return false;
  bool is = false;
  try {
    readJson(text, "", [&](const Json& json) {
      is = json.is_object() && json.contains("format") && json["format"] == kChebyshevFormat;
    });
  } catch (const InputError&) {
    is = true;  // damaged, which the reader will say
  }
  return is;
}

ChebyshevForm chebyshevFromJson(std::string_view text, const std::string& name) {
  ChebyshevForm form;
  readJson(text, name, [&](const Json& json) { form = readForm(json); });
  return form;
}

}  // namespace ltcfit
