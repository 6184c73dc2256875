#include "report/measurement_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <vector>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

void requireTexts(const JsonFields& fields, std::initializer_list<const char*> keys) {
  for (const char* key : keys) fields.text(key);
}

// Of processor time: shorter is below what a clock tells apart, longer than anybody waits.
constexpr double kLeastSeconds = 1e-9;
constexpr double kMostSeconds = 1e6;
// Of an error over the best known: far above any real one, and the decades of an axis stay few.
constexpr double kMostRatio = 1e30;

// Numbers, or null for what could not be measured.
void requireFigures(const JsonFields& fields, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (!fields.get(key).is_null()) fields.number(key);
}

void requireCounts(const JsonFields& fields, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (!fields.get(key).is_number_unsigned()) throw InputError(fields.where(key) + " is not a count");
}

// As requireCounts, and at least 1.
void requireSome(const JsonFields& fields, std::initializer_list<const char*> keys) {
  requireCounts(fields, keys);
  for (const char* key : keys)
    if (fields.get(key).get<std::uint64_t>() == 0) throw InputError(fields.where(key) + " is 0");
}

// Where both are numbers.
void requireOrder(const JsonFields& fields, const char* less, const char* more) {
  if (fields.get(less).is_null() || fields.get(more).is_null()) return;
  if (fields.number(less) > fields.number(more))
    throw InputError(fmt::format("{} is above {}", fields.where(less), more));
}

void requireSeconds(const JsonFields& seconds) {
  for (const char* key : {"low", "median", "high"}) {
    const double value = seconds.number(key);
    if (value < kLeastSeconds || value > kMostSeconds)
      throw InputError(fmt::format("{} is {:g}, not a time within {:g}..{:g} s", seconds.where(key), value,
                                   kLeastSeconds, kMostSeconds));
  }
  requireOrder(seconds, "low", "median");
  requireOrder(seconds, "median", "high");
}

void requireRatios(const JsonFields& error) {
  for (const char* key : {"low", "ratio", "high"}) {
    if (error.get(key).is_null()) continue;
    const double value = error.number(key);
    if (!(value > 0.0 && value < kMostRatio))
      throw InputError(
          fmt::format("{} is {:g}, not a ratio above 0 and below {:g}", error.where(key), value, kMostRatio));
  }
  requireOrder(error, "low", "ratio");
  requireOrder(error, "ratio", "high");
  requireOrder(error, "low", "high");
}

void requireTruths(const JsonFields& fields, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (!fields.get(key).is_boolean()) throw InputError(fields.where(key) + " is neither true nor false");
}

void requireNonEmpty(const JsonFields& fields, const char* key) {
  if (fields.array(key).empty()) throw InputError(fields.where(key) + " is empty");
}

void forEach(const JsonFields& fields, const char* key, const std::function<void(const JsonFields&)>& check) {
  const Json& array = fields.array(key);
  for (std::size_t i = 0; i < array.size(); ++i)
    check(JsonFields(array[i], fmt::format("{}[{}]", fields.where(key), i)));
}

void requireCountsByName(const JsonFields& fields, const char* key) {
  const JsonFields inner(fields.get(key), fields.where(key));
  for (const auto& [name, value] : fields.get(key).items()) requireCounts(inner, {name.c_str()});
}

void requireFormat(const JsonFields& file, const char* format) {
  if (!file.has("format") || !file.get("format").is_string() || file.text("format") != format)
    throw InputError(fmt::format("not what is asked for: format is not \"{}\"", format));
  if (!file.get("version").is_number_integer() || file.get("version").get<std::int64_t>() != 1)
    throw InputError("version is not 1, the only one known");
  requireTexts(file, {"command", "tool_version"});
}

void requireParameters(const JsonFields& fields) {
  for (const char* key : {"alpha_x", "alpha_y", "theta_degrees", "phi_degrees"}) fields.number(key);
}

void requireOneOf(const JsonFields& fields, const char* key, std::initializer_list<std::string_view> names) {
  const std::string text = fields.text(key);
  if (std::find(names.begin(), names.end(), text) == names.end())
    throw InputError(fmt::format("{} is not one of {}", fields.where(key), fmt::join(names, ", ")));
}

void checkPareto(const Json& json) {
  const JsonFields file(json, "");
  requireFormat(file, "ltcfit-pareto");
  requireOneOf(file, "table", {"iso", "aniso"});
  const JsonFields options(file.get("options"), "options");
  for (const auto& [key, value] : file.get("options").items())
    if (!value.is_primitive()) throw InputError(options.where(key.c_str()) + " is neither number nor text");
  requireNonEmpty(file, "entries");
  forEach(file, "entries", requireParameters);
  requireNonEmpty(file, "metrics");
  std::vector<std::string> metrics;
  forEach(file, "metrics", [&](const JsonFields& metric) {
    requireTexts(metric, {"unit", "meaning"});
    metrics.push_back(metric.text("name"));
  });
  requireNonEmpty(file, "settings");
  forEach(file, "settings", [&](const JsonFields& setting) {
    requireTexts(setting, {"fitter", "name", "preset"});
    setting.texts("default_of");
    const JsonFields effort(setting.get("effort"), setting.where("effort"));
    for (const auto& [key, value] : setting.get("effort").items()) effort.number(key.c_str());
    requireSome(setting, {"entries", "runs"});
    requireCounts(setting, {"not_converged", "non_finite"});
    requireSeconds(JsonFields(setting.get("cpu_seconds"), setting.where("cpu_seconds")));
    const JsonFields errors(setting.get("errors"), setting.where("errors"));
    for (const std::string& metric : metrics) {
      const JsonFields error(errors.get(metric.c_str()), errors.where(metric.c_str()));
      requireRatios(error);
      requireFigures(error, {"value"});
      requireTruths(error, {"front"});
    }
  });
  const std::size_t settings = file.array("settings").size();
  forEach(file, "defaults", [&](const JsonFields& choice) {
    requireTexts(choice, {"command", "why"});
    requireCounts(choice, {"setting"});
    if (choice.get("setting").get<std::uint64_t>() >= settings)
      throw InputError(fmt::format("{} is not one of the {} settings", choice.where("setting"), settings));
  });
}

void checkStability(const Json& json) {
  const JsonFields file(json, "");
  requireFormat(file, "ltcfit-stability");
  requireTexts(file, {"set"});
  forEach(file, "limits", [](const JsonFields& limit) {
    requireTexts(limit, {"id", "text"});
    requireFigures(limit, {"limit"});
  });
  file.texts("starts");
  file.numbers("seeds");
  forEach(file, "summary", [](const JsonFields& fitter) {
    requireTexts(fitter, {"fitter"});
    requireTruths(fitter, {"default"});
    requireCounts(fitter, {"rows", "non_finite", "runs"});
    if (fitter.get("default").get<bool>()) {
      requireCounts(fitter, {"failed"});
      requireOrder(fitter, "failed", "rows");
    }
    requireCountsByName(fitter, "outcomes");
  });
  forEach(file, "rows", [](const JsonFields& row) {
    requireParameters(row);
    requireTexts(row, {"fitter"});
    requireTruths(row, {"default"});
    if (row.get("default").get<bool>()) requireTruths(row, {"pass"});
    requireCounts(row, {"runs", "restarted", "handed_over", "start_kept", "non_finite", "det_negative"});
    requireCountsByName(row, "outcomes");
    requireFigures(
        row, {"sw1", "sw1_over_best", "tv", "spread_starts", "spread_seeds", "condition_m", "condition_raw",
              "condition_scaled", "gradient_error", "float32_shift", "half_shift", "interpolation"});
    const bool broken = !row.texts("broken").empty();
    if (row.get("default").get<bool>() && row.get("pass").get<bool>() == broken)
      throw InputError(fmt::format("{} is {}, and {} is {}", row.where("pass"), !broken ? "false" : "true",
                                   row.where("broken"), broken ? "not empty" : "empty"));
  });
  forEach(file, "findings", [](const JsonFields& finding) {
    requireTexts(finding, {"title", "text"});
    requireTruths(finding, {"seen"});
    requireCounts(finding, {"rows", "of"});
  });
}

Json checked(std::string_view text, const std::string& name, void (*check)(const Json&)) {
  Json out;
  readJson(text, name, [&](const Json& json) {
    check(json);
    out = json;
  });
  return out;
}

}  // namespace

Json paretoFromJson(std::string_view text, const std::string& name) {
  return checked(text, name, checkPareto);
}

Json stabilityFromJson(std::string_view text, const std::string& name) {
  return checked(text, name, checkStability);
}

}  // namespace ltcfit
