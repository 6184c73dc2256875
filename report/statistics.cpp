#include "report/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ltcfit {

Summary summarize(std::vector<double> values) {
  Summary s;
  const auto end = std::partition(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  s.nonFinite = static_cast<std::size_t>(values.end() - end);
  values.erase(end, values.end());
  s.count = values.size();
  if (values.empty()) return s;
  std::sort(values.begin(), values.end());
  const auto percentile = [&](double p) {
    const double rank = std::ceil(p * static_cast<double>(values.size()));
    return values[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
  };
  // sorted first, so that the sum, too, does not depend on the order the values came in
  s.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  s.p50 = percentile(0.50);
  s.p90 = percentile(0.90);
  s.p99 = percentile(0.99);
  s.max = values.back();
  return s;
}

}  // namespace ltcfit
