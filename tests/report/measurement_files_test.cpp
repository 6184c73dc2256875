#include "report/measurement_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

constexpr const char* kPareto = R"({"format": "ltcfit-pareto", "version": 1, "table": "iso",
  "command": "ltcfit pareto", "tool_version": "0", "options": {"entries": 1},
  "entries": [{"alpha_x": 0.1, "alpha_y": 0.1, "theta_degrees": 3, "phi_degrees": 0}],
  "metrics": [{"name": "SW1", "unit": "", "meaning": "m"}],
  "settings": [{"fitter": "l3", "name": "n", "effort": {"samples": 3}, "preset": "", "default_of": ["fit iso"],
    "entries": 1, "runs": 2, "cpu_seconds": {"median": 1, "low": 0.5, "high": 2},
    "errors": {"SW1": {"ratio": 2, "low": 1, "high": null, "value": null, "front": true}},
    "not_converged": 0, "non_finite": 0}],
  "defaults": [{"command": "fit iso", "setting": 0, "why": "w"}]})";

constexpr const char* kStability = R"({"format": "ltcfit-stability", "version": 1, "command": "c",
  "tool_version": "0", "set": "s", "limits": [{"id": "spread_starts", "text": "t", "limit": 0.01}],
  "starts": ["moments"], "seeds": [1],
  "summary": [{"fitter": "sw", "default": false, "rows": 1, "failed": 0, "non_finite": 0, "runs": 3,
    "outcomes": {"converged": 3}}],
  "rows": [{"alpha_x": 0.1, "alpha_y": 0.1, "theta_degrees": 3, "phi_degrees": 0, "fitter": "sw",
    "default": true, "runs": 3, "outcomes": {"converged": 3}, "restarted": 0, "handed_over": 0, "start_kept": 0,
    "non_finite": 0, "det_negative": 0,
    "sw1": 0.1, "sw1_over_best": 1, "tv": 0.1, "spread_starts": 0, "spread_seeds": 0, "condition_m": 2,
    "condition_raw": 2, "condition_scaled": 2, "gradient_error": null, "float32_shift": 0, "half_shift": 0,
    "interpolation": null, "pass": true, "broken": []}],
  "findings": [{"title": "t", "text": "x", "seen": true, "rows": 1, "of": 1}]})";

std::string messageOf(const std::function<void()>& f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// What is said of the file with one value replaced.
template <typename Read>
std::string damaged(const char* text, const char* pointer, const Json& value, Read read) {
  Json json = Json::parse(text);
  json[Json::json_pointer(pointer)] = value;
  return messageOf([&] { read(json.dump(), "f.json"); });
}

TEST(MeasurementFiles, WholeFilesAreTakenAsTheyAre) {
  EXPECT_EQ(paretoFromJson(kPareto, "p"), Json::parse(kPareto));
  EXPECT_EQ(stabilityFromJson(kStability, "s"), Json::parse(kStability));
}

TEST(MeasurementFiles, DamagedOnesAreRefusedByTheField) {
  const auto pareto = [](const char* pointer, const Json& value) {
    return damaged(kPareto, pointer, value, paretoFromJson);
  };
  EXPECT_EQ(pareto("/format", "ltc-table"), "f.json: not what is asked for: format is not \"ltcfit-pareto\"");
  EXPECT_EQ(pareto("/version", 2), "f.json: version is not 1, the only one known");
  EXPECT_EQ(pareto("/table", "both"), "f.json: table is not one of iso, aniso");
  EXPECT_EQ(pareto("/metrics", Json::array()), "f.json: metrics is empty");
  EXPECT_EQ(pareto("/settings", "x"), "f.json: settings is not an array");
  EXPECT_EQ(pareto("/settings/0/cpu_seconds/median", "1"),
            "f.json: settings[0].cpu_seconds.median is not a number");
  for (const double seconds : {0.0, -1.0, 1e-10, 1e7, 1e300})
    EXPECT_EQ(pareto("/settings/0/cpu_seconds/median", seconds),
              fmt::format("f.json: settings[0].cpu_seconds.median is {:g}, not a time within 1e-09..1e+06 s",
                          seconds));
  EXPECT_EQ(pareto("/settings/0/cpu_seconds/high", nullptr),
            "f.json: settings[0].cpu_seconds.high is not a number");
  EXPECT_EQ(pareto("/settings/0/cpu_seconds/low", 1.5),
            "f.json: settings[0].cpu_seconds.low is above median");
  EXPECT_EQ(pareto("/settings/0/cpu_seconds/high", 0.5),
            "f.json: settings[0].cpu_seconds.median is above high");
  for (const double ratio : {0.0, -2.0, 1e30, 1e300})
    EXPECT_EQ(pareto("/settings/0/errors/SW1/ratio", ratio),
              fmt::format("f.json: settings[0].errors.SW1.ratio is {:g}, not a ratio above 0 and below 1e+30",
                          ratio));
  EXPECT_EQ(pareto("/settings/0/errors/SW1/low", 3), "f.json: settings[0].errors.SW1.low is above ratio");
  EXPECT_EQ(pareto("/settings/0/errors/SW1/high", 1.5), "f.json: settings[0].errors.SW1.ratio is above high");
  EXPECT_EQ(pareto("/settings/0/errors/SW1/ratio", nullptr), "accepted");
  EXPECT_EQ(pareto("/settings/0/entries", 0), "f.json: settings[0].entries is 0");
  EXPECT_EQ(pareto("/settings/0/runs", 0), "f.json: settings[0].runs is 0");
  EXPECT_EQ(pareto("/settings/0/errors", Json::object()), "f.json: settings[0].errors.SW1 is missing");
  EXPECT_EQ(pareto("/settings/0/errors/SW1/front", 1),
            "f.json: settings[0].errors.SW1.front is neither true nor false");
  EXPECT_EQ(pareto("/settings/0/runs", -2), "f.json: settings[0].runs is not a count");
  EXPECT_EQ(pareto("/settings/0/effort/samples", Json::array()),
            "f.json: settings[0].effort.samples is not a number");
  EXPECT_EQ(pareto("/defaults/0/setting", 1), "f.json: defaults[0].setting is not one of the 1 settings");
  const auto stability = [](const char* pointer, const Json& value) {
    return damaged(kStability, pointer, value, stabilityFromJson);
  };
  EXPECT_EQ(stability("/rows/0/tv", "a"), "f.json: rows[0].tv is not a number");
  EXPECT_EQ(stability("/rows/0/outcomes", 3), "f.json: rows[0].outcomes is not an object");
  EXPECT_EQ(stability("/rows/0/outcomes/converged", nullptr),
            "f.json: rows[0].outcomes.converged is not a count");
  EXPECT_EQ(stability("/rows/0/broken", Json{1}), "f.json: rows[0].broken[0] is not a string");
  EXPECT_EQ(stability("/rows/0/pass", false), "f.json: rows[0].pass is false, and rows[0].broken is empty");
  EXPECT_EQ(stability("/rows/0/broken", Json{"tv"}),
            "f.json: rows[0].pass is true, and rows[0].broken is not empty");
  EXPECT_EQ(stability("/summary/0", Json{{"fitter", "sw"},
                                         {"default", true},
                                         {"rows", 1},
                                         {"failed", 2},
                                         {"non_finite", 0},
                                         {"runs", 3},
                                         {"outcomes", Json::object()}}),
            "f.json: summary[0].failed is above rows");
  EXPECT_EQ(stability("/findings/0/seen", "yes"), "f.json: findings[0].seen is neither true nor false");
  EXPECT_EQ(messageOf([] { stabilityFromJson(kPareto, "f.json"); }),
            "f.json: not what is asked for: format is not \"ltcfit-stability\"");
}

TEST(MeasurementFiles, EveryTruncationIsRefused) {
  const std::string text = kStability;
  for (std::size_t n = 0; n < text.size(); ++n)
    EXPECT_NE(messageOf([&] { stabilityFromJson(text.substr(0, n), "f.json"); }), "accepted") << n;
}

}  // namespace
}  // namespace ltcfit
