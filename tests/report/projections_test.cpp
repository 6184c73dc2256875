#include "report/projections.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ggx/random.h"

namespace ltcfit {
namespace {

TEST(Projections, SortsLikeTheStandardLibrary) {
  Random random(3);
  std::vector<double> values;
  std::vector<WeightedPosition> samples;
  for (int i = 0; i < 1000; ++i) {
    values.push_back(random.normal());
    samples.push_back({values.back(), random.uniform()});
  }
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  std::vector<WeightedPosition> expected = samples;
  std::sort(expected.begin(), expected.end(),
            [](const WeightedPosition& a, const WeightedPosition& b) { return a.position < b.position; });
  sortPositions(values);
  sortPositions(samples);
  EXPECT_EQ(values, sorted);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].position, expected[i].position);
    EXPECT_EQ(samples[i].weight, expected[i].weight);
  }
}

TEST(Projections, AreaBetweenCdfs) {
  // all at 0 against a quarter at 1 and the rest at 3: a quarter moves by 1, three quarters by 3
  const std::vector<double> model{0.0, 0.0};
  const std::vector<WeightedPosition> target{{1.0, 0.25}, {3.0, 0.75}};
  EXPECT_DOUBLE_EQ(cdfDistance(model, target), 2.5);
  const std::vector<WeightedPosition> weighted{{0.0, 0.5}, {3.0, 0.5}};
  EXPECT_DOUBLE_EQ(cdfDistance(weighted, target), 0.25 * 1.0 + 0.25 * 3.0);
}

}  // namespace
}  // namespace ltcfit
