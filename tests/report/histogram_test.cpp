#include "report/histogram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace ltcfit {
namespace {

TEST(Histogram, CountsEveryValueOnce) {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<std::vector<double>> sets{{0.011, 0.011, 0.5, 0.0, std::nan("")}, {0.9, inf, -1.0, 0.0}};
  const LogHistogram h = logHistogram(sets);
  // from the twelfth of a decade that holds 0.011, the first one above 0.01, to the end of the one of 0.9
  ASSERT_EQ(h.edges.size(), 25u);
  EXPECT_NEAR(h.edges.front(), 0.01, 1e-15);
  EXPECT_NEAR(h.edges.back(), 1.0, 1e-15);
  EXPECT_EQ(h.series[0].counts[0], 2u);
  EXPECT_EQ(h.series[0].counts[20], 1u);  // 0.5 = 10^(-3.6 / 12)
  EXPECT_EQ(h.series[1].counts[23], 1u);
  EXPECT_EQ(h.series[0].zero, 1u);
  EXPECT_EQ(h.series[0].nonFinite, 1u);
  EXPECT_EQ(h.series[1].zero, 2u);
  EXPECT_EQ(h.series[1].nonFinite, 1u);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const HistogramSeries& series = h.series[s];
    const std::size_t inBins = std::accumulate(series.counts.begin(), series.counts.end(), std::size_t{0});
    EXPECT_EQ(inBins + series.zero + series.nonFinite, sets[s].size());
  }
}

TEST(Histogram, ValuesFarBelowGoIntoTheFirstBin) {
  const std::vector<std::vector<double>> sets{{1e-300, 1.0, 2.0}};
  const LogHistogram h = logHistogram(sets, 24);
  ASSERT_EQ(h.edges.size(), 25u);
  EXPECT_EQ(h.series[0].counts[0], 1u);
  EXPECT_EQ(std::accumulate(h.series[0].counts.begin(), h.series[0].counts.end(), std::size_t{0}), 3u);
}

TEST(Histogram, NoPositiveValueNoBins) {
  const std::vector<std::vector<double>> sets{{0.0, std::nan("")}};
  const LogHistogram h = logHistogram(sets);
  EXPECT_TRUE(h.edges.empty());
  EXPECT_EQ(h.series[0].zero, 1u);
  EXPECT_EQ(h.series[0].nonFinite, 1u);
}

}  // namespace
}  // namespace ltcfit
