#include "report/pareto_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ltcfit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Of the first value, the first two, ...; 0 and infinity as they are.
std::vector<double> geometricMeans(const std::vector<double>& values) {
  std::vector<double> out;
  out.reserve(values.size());
  double sum = 0.0;
  for (const double v : values) {
    sum += std::log(v);
    out.push_back(std::exp(sum / static_cast<double>(out.size() + 1)));
  }
  return out;
}

// 1 where both are 0.
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

SettingErrors summarizeErrors(const SettingRuns& runs, std::size_t metric, const std::vector<double>& best) {
  std::vector<std::vector<double>> means;  // [repeat][entry]
  for (const std::vector<ParetoRun>& repeat : runs) {
    std::vector<double> ratios(repeat.size());
    for (std::size_t e = 0; e < repeat.size(); ++e) ratios[e] = over(repeat[e].errors[metric], best[e]);
    means.push_back(geometricMeans(ratios));
  }
  SettingErrors out;
  for (std::size_t e = 0; e < runs.front().size(); ++e) {
    std::vector<double> overRepeats(means.size());
    for (std::size_t r = 0; r < means.size(); ++r) overRepeats[r] = means[r][e];
    out.ratio = spreadOf(std::move(overRepeats));
    out.first.push_back(out.ratio.median);
  }
  out.value = out.ratio.median * geometricMeans(best).back();
  return out;
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

double errorOver(const SettingSummary& a, const SettingSummary& b, std::size_t metric) {
  const std::size_t last = std::min(a.entries, b.entries) - 1;
  return a.errors[metric].first[last] / b.errors[metric].first[last];
}

bool beats(const SettingSummary& a, const SettingSummary& b, std::size_t metric) {
  if (!std::isfinite(a.errors[metric].ratio.median)) return false;
  const double error = errorOver(a, b, metric);
  const double time = a.cpuSeconds.median / b.cpuSeconds.median;
  return time <= 1.0 && error <= 1.0 && (time < 1.0 || error < 1.0);
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
    for (std::size_t s = 0; s < runs.size(); ++s)
      out[s].errors[metric] = summarizeErrors(runs[s], metric, best);
    for (SettingSummary& own : out) {
      own.errors[metric].front = std::isfinite(own.errors[metric].ratio.median) &&
                                 std::none_of(out.begin(), out.end(), [&](const SettingSummary& other) {
                                   return beats(other, own, metric);
                                 });
    }
  }
  return out;
}

}  // namespace ltcfit
