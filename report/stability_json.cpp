#include "report/stability_json.h"

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "export/figure.h"

namespace ltcfit {
namespace {

using Json = nlohmann::ordered_json;

double degrees(double radians) {
  return std::round(radians / std::numbers::pi * 180.0 * 1e6) * 1e-6;
}

Json outcomesJson(const std::array<int, kOutcomeCount>& outcomes) {
  Json out = Json::object();
  for (std::size_t o = 0; o < kOutcomeCount; ++o)
    if (outcomes[o] > 0) out[outcomeName(static_cast<Outcome>(o))] = outcomes[o];
  return out;
}

Json rowJson(const StabilityRow& row) {
  int restarted = 0;
  int handedOver = 0;
  int startKept = 0;
  int negative = 0;
  Json results = Json::array();
  for (const StabilityRun& run : row.runs) {
    restarted += run.restarted ? 1 : 0;
    handedOver += run.handedOver ? 1 : 0;
    startKept += run.startKept ? 1 : 0;
    results.push_back({startName(run.start), run.seed, outcomeName(run.outcome), figure(run.sw1)});
    negative += run.detNegative ? 1 : 0;
  }
  const LobeParameters& p = row.parameters;
  return {{"alpha_x", p.alphaX},
          {"alpha_y", p.alphaY},
          {"theta_degrees", degrees(p.theta)},
          {"phi_degrees", degrees(p.phi)},
          {"fitter", fitterName(row.fitter)},
          {"default", row.isDefault},
          {"runs", row.runs.size()},
          {"outcomes", outcomesJson(row.outcomes)},
          {"restarted", restarted},
          {"handed_over", handedOver},
          {"start_kept", startKept},
          {"non_finite", row.nonFinite},
          {"det_negative", negative},
          {"sw1", figure(row.sw1)},
          {"sw1_over_best", figure(row.sw1OverBest)},
          {"tv", figure(row.tv)},
          {"spread_starts", figure(row.spreadStarts)},
          {"spread_seeds", figure(row.spreadSeeds)},
          {"condition_m", figure(row.conditionM)},
          {"condition_raw", figure(row.probe.conditionRaw)},
          {"condition_scaled", figure(row.probe.conditionScaled)},
          {"gradient_error", row.probe.gradientError ? figure(*row.probe.gradientError) : Json(nullptr)},
          {"float32_shift", figure(row.float32Shift)},
          {"half_shift", figure(row.halfShift)},
          {"interpolation", row.interpolation ? figure(*row.interpolation) : Json(nullptr)},
          {"pass", row.isDefault ? Json(row.broken.empty()) : Json(nullptr)},
          {"broken", row.broken},
          {"results", results}};
}

Json summaryJson(Fitter fitter, const std::vector<StabilityRow>& rows) {
  std::array<int, kOutcomeCount> outcomes{};
  std::size_t count = 0, failed = 0, runs = 0;
  int nonFinite = 0;
  for (const StabilityRow& row : rows) {
    if (row.fitter != fitter) continue;
    ++count;
    failed += row.broken.empty() ? 0 : 1;
    runs += row.runs.size();
    nonFinite += row.nonFinite;
    for (std::size_t o = 0; o < kOutcomeCount; ++o) outcomes[o] += row.outcomes[o];
  }
  return {{"fitter", fitterName(fitter)},
          {"default", fitter == kDefaultFitter},
          {"rows", count},
          {"failed", fitter == kDefaultFitter ? Json(failed) : Json(nullptr)},
          {"non_finite", nonFinite},
          {"runs", runs},
          {"outcomes", outcomesJson(outcomes)}};
}

}  // namespace

Json stabilityJson(const StabilityResult& result, const StabilityOptions& options, const std::string& set,
                   const std::string& command) {
  Json out{{"format", "ltcfit-stability"},   {"version", 1}, {"command", command},
           {"tool_version", LTCFIT_VERSION}, {"set", set},   {"lobes", options.lobes.size()}};
  out["limits"] = Json::array();
  for (const StabilityLimit& limit : stabilityLimits())
    out["limits"].push_back({{"id", limit.id}, {"text", limit.text}, {"limit", limit.limit}});
  out["starts"] = Json::array();
  for (std::size_t s = 0; s < kStartCount; ++s) out["starts"].push_back(startName(static_cast<Start>(s)));
  out["seeds"] = Json::array();
  for (int seed = 1; seed <= options.seeds; ++seed) out["seeds"].push_back(seed);
  out["summary"] = Json::array();
  for (const Fitter fitter : options.fitters) out["summary"].push_back(summaryJson(fitter, result.rows));
  out["findings"] = Json::array();
  for (const StabilityFinding& f : result.findings) {
    out["findings"].push_back(
        {{"title", f.title}, {"text", f.text}, {"seen", f.rows > 0}, {"rows", f.rows}, {"of", f.of}});
  }
  out["rows"] = Json::array();
  for (const StabilityRow& row : result.rows) out["rows"].push_back(rowJson(row));
  return out;
}

}  // namespace ltcfit
