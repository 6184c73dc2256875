#include "report/measurement_files.h"

#include <fmt/format.h>

#include <vector>

#include "export/atomic_file.h"
#include "report/json_checks.h"

namespace ltcfit {
namespace {

// Of an error over the best known: far above any real one, and the decades of an axis stay few.
constexpr double kMostRatio = 1e30;

void requireTimes(const JsonFields& seconds) {
  for (const char* key : {"low", "median", "high"}) requireSeconds(seconds, key);
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

void requireParameters(const JsonFields& fields) {
  for (const char* key : {"alpha_x", "alpha_y", "theta_degrees", "phi_degrees"}) fields.number(key);
}

void checkPareto(const JsonFields& file) {
  requireFormat(file, "ltcfit-pareto");
  requireOneOf(file, "table", {"iso", "aniso"});
  requireOptions(file, "options");
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
    requireTimes(JsonFields(setting.get("cpu_seconds"), setting.where("cpu_seconds")));
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

void checkStability(const JsonFields& file) {
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

}  // namespace

Json paretoFromJson(std::string_view text, const std::string& name) {
  return checkedJson(text, name, checkPareto);
}

Json stabilityFromJson(std::string_view text, const std::string& name) {
  return checkedJson(text, name, checkStability);
}

}  // namespace ltcfit
