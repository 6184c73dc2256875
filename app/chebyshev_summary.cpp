#include "app/chebyshev_summary.h"

#include <fmt/format.h>

#include <iterator>

#include "report/score.h"

namespace ltcfit::app {
namespace {

// Enough for ratios of means good to some percent; errors of the two go up and down together.
constexpr std::size_t kPoints = 512;

std::string errorLines(const Table& table, const Table& expanded) {
  ScoreOptions options;
  options.set = PointSet::kOffGrid;
  options.count = kPoints;
  const std::vector<Score> scores = scoreTables({&table, &expanded}, options);
  std::string out =
      fmt::format("{} points off-grid, seed {}: error of the polynomials (over the table's own)\n", kPoints,
                  options.metrics.seed);
  fmt::format_to(std::back_inserter(out), "  {:<14}{:>22}{:>22}{:>22}\n", "", "mean", "p99", "max");
  for (const Metric metric : {Metric::kForm, Metric::kLightS, Metric::kLightM, Metric::kLightL, Metric::kTv,
                              Metric::kBelow, Metric::kAlbedoError, Metric::kFresnelError}) {
    const auto m = static_cast<std::size_t>(metric);
    const Summary& own = scores[0].summary[m];
    const Summary& form = scores[1].summary[m];
    const auto cell = [](double a, double b) { return fmt::format("{:.3e} ({:.3f})", a, a / b); };
    fmt::format_to(std::back_inserter(out), "  {:<14}{:>22}{:>22}{:>22}\n", metricName(metric),
                   cell(form.mean, own.mean), cell(form.p99, own.p99), cell(form.max, own.max));
  }
  return out;
}

}  // namespace

std::string chebyshevSummary(const Table& table, const Table& expanded, const ChebyshevDifference& d,
                             bool measured) {
  const std::string line = fmt::format(
      "polynomials against the table, mean (largest): lobes shifted by {:.4f} ({:.3f}) of their spread, "
      "norm off by\n      {:.5f} ({:.4f}), Fresnel by {:.5f} ({:.4f})\n",
      d.meanShift, d.largestShift, d.meanNorm, d.largestNorm, d.meanFresnel, d.largestFresnel);
  return measured ? line + errorLines(table, expanded) : line;
}

}  // namespace ltcfit::app
