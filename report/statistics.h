// How a set of figures is summed up.
#pragma once

#include <cstddef>
#include <vector>

namespace ltcfit {

/// Mean, percentiles and maximum of the finite values; the others are only counted.
struct Summary {
  double mean = 0.0;
  double p50 = 0.0;
  double p90 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
  std::size_t count = 0;      ///< finite values
  std::size_t nonFinite = 0;  ///< NaN and infinities
};

/// Percentiles by the nearest rank: p99 of 64 values is the largest. All zero where no value is finite.
Summary summarize(std::vector<double> values);

}  // namespace ltcfit
