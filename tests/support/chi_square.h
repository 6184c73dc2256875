// Pearson's chi-square test of counts against expected counts.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace ltcfit::test {

/// How many standard deviations the statistic lies above its mean, by the cube-root approximation of Wilson
/// and Hilferty (good to a few percent of a deviation for 30 or more degrees of freedom). Neighbouring bins
/// are pooled until each expects 10 or more.
inline double chiSquareDeviations(const std::vector<double>& observed, const std::vector<double>& expected) {
  double statistic = 0.0;
  double o = 0.0;
  double e = 0.0;
  int bins = 0;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    o += observed[i];
    e += expected[i];
    if (e < 10.0) continue;
    statistic += (o - e) * (o - e) / e;
    ++bins;
    o = e = 0.0;
  }
  // What is left over expects less than 10: too little for a bin, but samples where none may be must count.
  if (o > 0.0 || e > 0.0) {
    statistic += (o - e) * (o - e) / (e + 1.0);
    ++bins;
  }
  const double k = static_cast<double>(bins - 1);
  const double spread = 2.0 / (9.0 * k);
  return (std::cbrt(statistic / k) - (1.0 - spread)) / std::sqrt(spread);
}

/// Deviations that a correct sampler exceeds with probability 0.01 in any of n tests together (Sidak): the
/// quantile of the normal distribution at (1 - 0.01)^(1/n).
inline double sidakThreshold(int n) {
  const double p = std::pow(0.99, 1.0 / n);
  double low = 0.0;
  double high = 40.0;
  for (int i = 0; i < 100; ++i) {
    const double mid = 0.5 * (low + high);
    (0.5 * std::erfc(-mid / std::sqrt(2.0)) < p ? low : high) = mid;
  }
  return high;
}

}  // namespace ltcfit::test
