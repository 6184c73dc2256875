#include "report/pareto.h"

#include <omp.h>
#include <time.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

#include "fit/parallel_for.h"
#include "fit/target_lobe.h"
#include "report/front.h"
#include "report/pareto_entries.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
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
  run.errors.fill(kInfinity);
  Matrix3d m = fit.m / fit.m.col(2).norm();
  if (!m.allFinite() || m.determinant() == 0.0 || !m.inverse().allFinite()) return run;
  if (m.determinant() < 0.0) m.col(1) *= -1.0;  // the same lobe
  const std::array<double, kParetoMetrics> errors = errorsOf(metrics.evaluate(Ltc(m)));
  if (std::all_of(errors.begin(), errors.end(), [](double e) { return std::isfinite(e); }))
    run.errors = errors;
  return run;
}

// exp of the mean logarithm; 0 and infinity as they are.
double geometricMean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += std::log(v);
  return std::exp(sum / static_cast<double>(values.size()));
}

// 1 where both are 0 or the best is no better than infinite.
double over(double error, double best) {
  if (!std::isfinite(error)) return kInfinity;
  return error == best ? 1.0 : error / best;
}

// The best error at each entry, of any run.
std::vector<double> bestErrors(const std::vector<SettingRuns>& runs, std::size_t metric) {
  std::vector<double> best;
  for (const SettingRuns& setting : runs) {
    for (const std::vector<ParetoRun>& repeat : setting) {
      best.resize(std::max(best.size(), repeat.size()), kInfinity);
      for (std::size_t e = 0; e < repeat.size(); ++e) best[e] = std::min(best[e], repeat[e].errors[metric]);
    }
  }
  return best;
}

}  // namespace

const std::array<ParetoMetric, kParetoMetrics>& paretoMetrics() {
  static constexpr std::array<ParetoMetric, kParetoMetrics> kMetrics{{
      {"SW1", "", "Mean over projections of the distance between the CDFs of lobe and fit."},
      {"SW1rel", "", "SW1 over the lobe's width."},
      {"form", "", "Mean difference of the integrals of lobe and fit over random quads near the lobe."},
      {"light_s", "",
       "RMS error of the reflected light over random lights of half-size 0.05 anywhere above."},
      {"light_m", "", "The same for lights of half-size 0.25."},
      {"light_l", "", "The same for lights of half-size 0.8."},
      {"light", "", "Geometric mean of light_s, light_m and light_l."},
      {"L3", "sr^-2/3", "L3 norm of the difference of the densities."},
      {"TV", "", "Total variation: half the integral of the difference of the densities."},
  }};
  return kMetrics;
}

Spread spreadOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1
                            ? values[middle]
                            : values[middle - 1] + 0.5 * (values[middle] - values[middle - 1]);
  // of two infinite ones the difference is no number
  return {std::isnan(median) ? values[middle] : median, values.front(), values.back()};
}

std::vector<SettingSummary> summarizePareto(const std::vector<SettingRuns>& runs) {
  std::vector<SettingSummary> out(runs.size());
  for (std::size_t s = 0; s < runs.size(); ++s) {
    std::vector<double> seconds;
    for (const std::vector<ParetoRun>& repeat : runs[s]) {
      double sum = 0.0;
      for (const ParetoRun& run : repeat) {
        sum += run.cpuSeconds;
        out[s].notConverged += run.converged ? 0 : 1;
        out[s].nonFinite += std::isfinite(run.errors[0]) ? 0 : 1;
      }
      seconds.push_back(sum / static_cast<double>(repeat.size()));
      out[s].runs += repeat.size();
    }
    out[s].entries = runs[s].front().size();
    out[s].cpuSeconds = spreadOf(std::move(seconds));
  }
  for (std::size_t metric = 0; metric < kParetoMetrics; ++metric) {
    const std::vector<double> best = bestErrors(runs, metric);
    const double bestMean = geometricMean(best);
    std::vector<CostAndError> choices;
    for (std::size_t s = 0; s < runs.size(); ++s) {
      std::vector<double> means;
      for (const std::vector<ParetoRun>& repeat : runs[s]) {
        std::vector<double> ratios;
        for (std::size_t e = 0; e < repeat.size(); ++e)
          ratios.push_back(over(repeat[e].errors[metric], best[e]));
        means.push_back(geometricMean(ratios));
      }
      SettingErrors& errors = out[s].errors[metric];
      errors.ratio = spreadOf(std::move(means));
      errors.value = errors.ratio.median * bestMean;
      choices.push_back({out[s].cpuSeconds.median, errors.ratio.median});
    }
    const std::vector<bool> front = paretoFront(choices);
    for (std::size_t s = 0; s < runs.size(); ++s) out[s].errors[metric].front = front[s];
  }
  return out;
}

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
  const int threads = options.threads > 0 ? options.threads : omp_get_max_threads();
  std::mutex progressMutex;
  double done = 0.0;
  parallelFor(options.entries * options.repeats, threads, [&](std::size_t i) {
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
    return [] {};
  });
  result.summaries = summarizePareto(runs);
  return result;
}

}  // namespace ltcfit
