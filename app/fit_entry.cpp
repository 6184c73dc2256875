// ltcfit fit entry: one lobe, for those who want to look at a fit or to time it.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/commands.h"
#include "app/fit_runs.h"
#include "app/fit_summary.h"
#include "base/diagnostics.h"
#include "export/atomic_file.h"
#include "fit/moment_start.h"
#include "fit/target_lobe.h"
#include "ltc/ltc.h"
#include "report/metrics.h"

namespace ltcfit::app {
namespace {

// SW1 on samples that the fit has not seen.
double unseenSw1(const Lobe& lobe, const Eigen::Matrix3d& m, std::uint64_t seed) {
  const LobeSamples target = weightedSamples(lobe, 32768, mixSeed(seed, 50));
  ProjectedCdfLoss loss(target, momentStart(target), cosineSamples(32768, mixSeed(seed, 51)),
                        familySlices(MatrixFamily::kGeneral, 256));
  return loss(m, nullptr);
}

double radians(double degrees) {
  return degrees == 90.0 ? 0.5 * std::numbers::pi : degrees / 180.0 * std::numbers::pi;
}

}  // namespace

int fitEntryCommand(const EntryArguments& a) {
  if (!std::isfinite(a.alphaX + a.alphaY + a.theta + a.phi))  // which CLI11's ranges let through
    throw InputError("--alpha-x, --alpha-y, --theta and --phi must be numbers");
  const LobeParameters p{a.alphaX, a.alphaY > 0.0 ? a.alphaY : a.alphaX, radians(a.theta), radians(a.phi)};
  requireFitMemory(a.fit, 1);
  const TableFitOptions options = toFitOptions(a.fit);
  const Stopwatch watch;
  JobResult r = fitJob({p, familyOf(p)}, "ggx", options);
  const Times times = watch.elapsed();
  if (!r.fitted) {
    complain("the fit ended with a matrix without an inverse");
    return kExitQuality;
  }
  r.m = projectOnFamily(r.m, familyOf(p));
  const std::unique_ptr<Lobe> lobe = makeTargetLobe("ggx", p);
  const double sw1 = unseenSw1(*lobe, r.m, static_cast<std::uint64_t>(a.fit.seed));
  MetricOptions unseen;
  unseen.samples = 1024;
  unseen.lights = 512;
  unseen.seed = static_cast<std::uint64_t>(a.fit.seed) + 1;
  const MetricTarget target(*lobe, unseen);
  const EntryMetrics metrics = target.evaluate(Ltc(r.m));
  const double spread = target.moments().spread;
  const double below = metrics.get(Metric::kBelow);
  constexpr std::array<Metric, 3> kLights{Metric::kLightS, Metric::kLightM, Metric::kLightL};
  if (a.fit.json) {
    nlohmann::ordered_json out{
        {"alpha_x", p.alphaX},      {"alpha_y", p.alphaY},
        {"theta_degrees", a.theta}, {"phi_degrees", a.phi},
        {"fitter", a.fit.fitter},   {"preset", a.fit.fitter == "l3" ? "" : presetOf(a.fit)},
        {"seed", a.fit.seed}};
    if (options.fitter == Fitter::kLight) {
      out.update({{"lights", options.light.lights.lights},
                  {"weighting", a.fit.weighting},
                  {"size_exponent", options.light.lights.sizeExponent},
                  {"leak_weight", options.light.leakWeight},
                  {"integral_error", r.integralError}});
    }
    for (int row = 0; row < 3; ++row) out["m"].push_back({r.m(row, 0), r.m(row, 1), r.m(row, 2)});
    out.update({{"norm", r.norm},
                {"fresnel", r.fresnel},
                {"termination", terminationName(r.termination)},
                {"evaluations", r.evaluations},
                {"cpu_seconds", times.cpu},
                {"start_sw1", r.startLoss},
                {"fit_sw1", r.loss}});
    out["unseen"] = {{"SW1", sw1}, {"SW1rel", sw1 / spread}};
    for (const Metric m : kLights) out["unseen"][metricName(m)] = metrics.get(m);
    out["below"] = below;
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
  fmt::print("SW1 on unseen samples {:.6f}, {:.4f} of the lobe's spread; below the horizon {:.5f}\n", sw1,
             sw1 / spread, below);
  fmt::print("RMS error of unseen lights: small {:.3e}, medium {:.3e}, large {:.3e}\n",
             metrics.get(kLights[0]), metrics.get(kLights[1]), metrics.get(kLights[2]));
  return kExitOk;
}

}  // namespace ltcfit::app
