#include "report/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ltcfit {
namespace {

TEST(Summary, KnownAnswers) {
  std::vector<double> values;
  for (int i = 100; i >= 1; --i) values.push_back(i);
  const Summary s = summarize(values);
  EXPECT_DOUBLE_EQ(s.mean, 50.5);
  EXPECT_EQ(s.p50, 50.0);
  EXPECT_EQ(s.p90, 90.0);
  EXPECT_EQ(s.p99, 99.0);
  EXPECT_EQ(s.max, 100.0);
  EXPECT_EQ(s.count, 100u);
  EXPECT_EQ(s.nonFinite, 0u);
}

TEST(Summary, NonFiniteValuesAreCountedNotAveraged) {
  const Summary s = summarize({1.0, std::nan(""), 3.0, std::numeric_limits<double>::infinity()});
  EXPECT_DOUBLE_EQ(s.mean, 2.0);
  EXPECT_EQ(s.count, 2u);
  EXPECT_EQ(s.nonFinite, 2u);
}

TEST(Summary, OfNothing) {
  EXPECT_EQ(summarize({}).count, 0u);
  EXPECT_EQ(summarize({std::nan("")}).nonFinite, 1u);
}

TEST(Summary, DoesNotDependOnTheOrder) {
  EXPECT_EQ(summarize({0.1, 0.2, 0.3, 1e-9}).mean, summarize({1e-9, 0.3, 0.2, 0.1}).mean);
}

}  // namespace
}  // namespace ltcfit
