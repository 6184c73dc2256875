#include "report/pareto_json.h"

#include <nlohmann/json.hpp>

#include "base/angles.h"
#include "export/figure.h"
#include "report/pareto_text.h"

namespace ltcfit {
namespace {

using Json = nlohmann::ordered_json;

Json settingToJson(const FitSetting& setting, const SettingSummary& summary, const Json& defaultOf) {
  Json effort = Json::object();
  for (const auto& [name, value] : setting.effort) effort[name] = value;
  Json errors = Json::object();
  for (std::size_t m = 0; m < kParetoMetrics; ++m) {
    const SettingErrors& e = summary.errors[m];
    errors[std::string(paretoMetrics()[m].name)] = {{"ratio", figure(e.ratio.median)},
                                                    {"low", figure(e.ratio.low)},
                                                    {"high", figure(e.ratio.high)},
                                                    {"value", figure(e.value)},
                                                    {"front", e.front}};
  }
  return {{"fitter", setting.fitter},
          {"name", setting.name},
          {"effort", effort},
          {"preset", setting.preset},
          {"default_of", defaultOf},
          {"entries", summary.entries},
          {"runs", summary.runs},
          {"cpu_seconds",
           {{"median", figure(summary.cpuSeconds.median)},
            {"low", figure(summary.cpuSeconds.low)},
            {"high", figure(summary.cpuSeconds.high)}}},
          {"errors", errors},
          {"not_converged", summary.notConverged},
          {"non_finite", summary.nonFinite}};
}

}  // namespace

Json paretoToJson(const ParetoOptions& options, const ParetoResult& result, const std::string& command) {
  Json out{{"format", "ltcfit-pareto"},
           {"version", 1},
           {"table", options.kind == TableKind::kIsotropic ? "iso" : "aniso"},
           {"command", command},
           {"tool_version", LTCFIT_VERSION},
           {"options",
            {{"entries", options.entries},
             {"repeats", options.repeats},
             {"seed", options.seed},
             {"samples", options.metrics.samples},
             {"directions", options.metrics.directions},
             {"quads", options.metrics.quads},
             {"lights", options.metrics.lights}}}};
  out["entries"] = Json::array();
  for (const LobeParameters& p : result.entries) {
    out["entries"].push_back({{"alpha_x", figure(p.alphaX)},
                              {"alpha_y", figure(p.alphaY)},
                              {"theta_degrees", figure(kDegreesPerRadian * p.theta)},
                              {"phi_degrees", figure(kDegreesPerRadian * p.phi)}});
  }
  out["metrics"] = Json::array();
  for (const ParetoMetric& m : paretoMetrics())
    out["metrics"].push_back({{"name", m.name}, {"unit", m.unit}, {"meaning", m.meaning}});
  const std::vector<ParetoDefault> defaults = explainDefaults(options.kind, result);
  out["settings"] = Json::array();
  for (std::size_t s = 0; s < result.settings.size(); ++s) {
    Json defaultOf = Json::array();
    for (const ParetoDefault& d : defaults)
      if (d.setting == s) defaultOf.push_back(d.command);
    out["settings"].push_back(settingToJson(result.settings[s], result.summaries[s], defaultOf));
  }
  out["defaults"] = Json::array();
  for (const ParetoDefault& d : defaults)
    out["defaults"].push_back({{"command", d.command}, {"setting", d.setting}, {"why", d.why}});
  return out;
}

}  // namespace ltcfit
