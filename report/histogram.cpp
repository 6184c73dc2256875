#include "report/histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ltcfit {

LogHistogram logHistogram(std::span<const std::vector<double>> sets, int most) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const std::vector<double>& values : sets) {
    for (const double v : values) {
      if (!std::isfinite(v) || v <= 0.0) continue;
      low = std::min(low, v);
      high = std::max(high, v);
    }
  }
  LogHistogram out;
  // edges at whole twelfths of a decade, so that they are the same whatever the values are
  const double first = std::floor(std::log10(low) * kBinsPerDecade);
  const double last = std::floor(std::log10(high) * kBinsPerDecade) + 1.0;
  if (high > 0.0) {
    const int bins = static_cast<int>(std::min(last - first, static_cast<double>(most)));
    for (int i = bins; i >= 0; --i) out.edges.push_back(std::pow(10.0, (last - i) / kBinsPerDecade));
  }
  for (const std::vector<double>& values : sets) {
    HistogramSeries series;
    series.counts.assign(out.edges.empty() ? 0 : out.edges.size() - 1, 0);
    for (const double v : values) {
      if (!std::isfinite(v)) {
        ++series.nonFinite;
      } else if (v <= 0.0) {
        ++series.zero;
      } else {
        const auto above = std::upper_bound(out.edges.begin(), out.edges.end(), v) - out.edges.begin();
        ++series.counts[static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(above - 1, 0, static_cast<std::ptrdiff_t>(series.counts.size()) - 1))];
      }
    }
    out.series.push_back(std::move(series));
  }
  return out;
}

}  // namespace ltcfit
