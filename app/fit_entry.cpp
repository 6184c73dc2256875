// ltcfit fit entry: one lobe, for those who want to look at a fit or to time it.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "app/commands.h"
#include "app/fit_runs.h"
#include "app/fit_summary.h"
#include "fit/target_lobe.h"
#include "report/metrics.h"

namespace ltcfit::app {
namespace {

constexpr std::array<Metric, 9> kEntryMetrics{Metric::kSw1,    Metric::kSw1Rel, Metric::kForm,
                                              Metric::kLightS, Metric::kLightM, Metric::kLightL,
                                              Metric::kTv,     Metric::kL3,     Metric::kBelow};

double radians(double degrees) {
  return degrees == 90.0 ? 0.5 * std::numbers::pi : degrees / 180.0 * std::numbers::pi;
}

}  // namespace

int fitEntryCommand(const EntryArguments& a) {
  const LobeParameters p{a.alphaX, a.alphaY > 0.0 ? a.alphaY : a.alphaX, radians(a.theta), radians(a.phi)};
  const TableFitOptions options = toFitOptions(a.fit);
  const Stopwatch watch;
  const JobResult r = fitJob({p, familyOf(p)}, "ggx", options);
  const Times times = watch.elapsed();
  if (!r.fitted) {
    fmt::print(stderr, "ltcfit: the fit ended with a matrix without an inverse\n");
    return kExitQuality;
  }
  const std::unique_ptr<Lobe> lobe = makeTargetLobe("ggx", p);
  MetricOptions judge;
  judge.samples = 16384;
  judge.directions = 256;
  judge.seed = static_cast<std::uint64_t>(a.fit.seed) + 1;
  const EntryMetrics metrics = MetricTarget(*lobe, judge).evaluate(Ltc(r.m));
  if (a.fit.json) {
    nlohmann::ordered_json out{
        {"alpha_x", p.alphaX}, {"alpha_y", p.alphaY}, {"theta", p.theta}, {"phi", p.phi}};
    for (int row = 0; row < 3; ++row) out["m"].push_back({r.m(row, 0), r.m(row, 1), r.m(row, 2)});
    out.update({{"norm", r.norm},
                {"fresnel", r.fresnel},
                {"termination", terminationName(r.termination)},
                {"evaluations", r.evaluations},
                {"cpu_seconds", times.cpu},
                {"start_sw1", r.startLoss},
                {"fit_sw1", r.loss}});
    for (Metric m : kEntryMetrics) out["unseen"][metricName(m)] = metrics.get(m);
    fmt::print("{}\n", out.dump(2));
    return kExitOk;
  }
  fmt::print("alpha {:g} x {:g}, theta {:g}, phi {:g} degrees\n", p.alphaX, p.alphaY, a.theta, a.phi);
  fmt::print("M, aligned, third column of length 1:\n");
  for (int row = 0; row < 3; ++row)
    fmt::print("  {:>13.6g}{:>13.6g}{:>13.6g}\n", r.m(row, 0), r.m(row, 1), r.m(row, 2));
  fmt::print("norm {:.6f}, Fresnel {:.6f}\n", r.norm, r.fresnel);
  fmt::print("{} evaluations, {}, {:.4f} CPU s; SW1 by the fit's samples {:.6f}, from {:.6f}\n",
             r.evaluations, terminationName(r.termination), times.cpu, r.loss, r.startLoss);
  fmt::print("on unseen samples:\n");
  for (Metric m : kEntryMetrics) fmt::print("  {:<8} {:.6g}\n", metricName(m), metrics.get(m));
  return kExitOk;
}

}  // namespace ltcfit::app
