// Histograms of error figures over several tables, with the same bins.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace ltcfit {

/// Counts of one table. What no bin holds is counted beside them, so that nothing is lost.
struct HistogramSeries {
  std::vector<std::size_t> counts;
  std::size_t zero = 0;       ///< values that are 0 or below
  std::size_t nonFinite = 0;  ///< NaN and infinities
};

/// Bins that are evenly spaced in the logarithm.
struct LogHistogram {
  std::vector<double> edges;            ///< increasing, one more than bins; empty where no value is positive
  std::vector<HistogramSeries> series;  ///< one for each set of values
};

/// Bins of a twelfth of a decade at least from the smallest to the largest positive value of all sets, `most`
/// of them or fewer: values below the lowest edge are then counted in the first bin.
inline constexpr int kBinsPerDecade = 12;
LogHistogram logHistogram(std::span<const std::vector<double>> sets, int most = 60);

}  // namespace ltcfit
