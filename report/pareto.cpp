#include "report/pareto.h"

#include <time.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/parallel_for.h"
#include "fit/target_lobe.h"
#include "report/pareto_entries.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;

constexpr std::string_view kBrdf = "ggx";
// What measuring a fit takes next to fitting it, for the progress alone.
constexpr double kSecondsAMeasurement = 0.01;

double threadSeconds() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::array<double, kParetoMetrics> errorsOf(const EntryMetrics& e) {
  const double s = e.get(Metric::kLightS);
  const double m = e.get(Metric::kLightM);
  const double l = e.get(Metric::kLightL);
  return {e.get(Metric::kSw1),  e.get(Metric::kSw1Rel), e.get(Metric::kForm), s, m, l,
          std::cbrt(s * m * l), e.get(Metric::kL3),     e.get(Metric::kTv)};
}

ParetoRun fitAndMeasure(const FitSetting& setting, const LobeParameters& parameters, std::uint64_t seed,
                        const MetricTarget& metrics) {
  LobeFitOptions options = setting.options;
  options.setSeed(seed);
  ParetoRun run;
  LobeFit fit;
  const double before = threadSeconds();
  {
    LobeFitTarget target({parameters, familyOf(parameters)}, kBrdf, options);
    if (setting.fits()) {
      fit = fitLobe(target, target.momentStart(), options);
    } else {
      fit.m = target.momentStart();
      fit.termination = Termination::kConverged;
    }
  }
  run.cpuSeconds = threadSeconds() - before;
  run.converged = fit.termination == Termination::kConverged;
  run.errors.fill(std::numeric_limits<double>::infinity());
  Matrix3d m = fit.m / fit.m.col(2).norm();
  if (!m.allFinite() || m.determinant() == 0.0 || !m.inverse().allFinite()) return run;
  if (m.determinant() < 0.0) m.col(1) *= -1.0;  // the same lobe
  const std::array<double, kParetoMetrics> errors = errorsOf(metrics.evaluate(Ltc(m)));
  if (std::all_of(errors.begin(), errors.end(), [](double e) { return std::isfinite(e); }))
    run.errors = errors;
  return run;
}

}  // namespace

ParetoResult runPareto(const ParetoOptions& options, const ParetoProgress& progress) {
  ParetoResult result;
  result.entries = paretoEntries(options.kind, options.entries);
  for (FitSetting& s : paretoLadder(options.kind)) {
    const auto& wanted = options.fitters;
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), s.fitter) != wanted.end())
      result.settings.push_back(std::move(s));
  }
  const std::size_t settings = result.settings.size();
  std::vector<SettingRuns> runs(settings);
  double total = 0.0;
  for (std::size_t s = 0; s < settings; ++s) {
    const FitShare share = shareOf(result.settings[s], options.entries, options.repeats);
    runs[s].assign(share.repeats, std::vector<ParetoRun>(share.entries));
    total += static_cast<double>(share.repeats * share.entries) *
             (nominalSeconds(result.settings[s]) + kSecondsAMeasurement);
  }

  // All settings of an entry and repeat one after the other, so that what slows the machine for a while slows
  // them alike. The longest come first: costly settings take part in the first entries and repeats.
  std::mutex progressMutex;
  double done = 0.0;
  parallelFor(options.entries * options.repeats, {.threads = options.threads}, [&](std::size_t i) {
    const std::size_t repeat = i / options.entries;
    const std::size_t entry = i % options.entries;
    MetricOptions unseen = options.metrics;
    unseen.seed = mixSeed(options.seed, 1000 + entry);
    const std::unique_ptr<Lobe> lobe = makeTargetLobe(kBrdf, result.entries[entry]);
    const MetricTarget metrics(*lobe, unseen);
    for (std::size_t s = 0; s < settings; ++s) {
      if (repeat >= runs[s].size() || entry >= runs[s][repeat].size()) continue;
      runs[s][repeat][entry] =
          fitAndMeasure(result.settings[s], result.entries[entry], options.seed + repeat, metrics);
      const std::lock_guard lock(progressMutex);
      done += nominalSeconds(result.settings[s]) + kSecondsAMeasurement;
      if (progress) progress(done, total);
    }
  });
  result.summaries = summarizePareto(runs);
  return result;
}

}  // namespace ltcfit
