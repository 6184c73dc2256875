#include "tailor/lobe_distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "tests/tailor/support.h"

namespace ltcfit {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

TEST(LobeDistribution, LobesComeAsOftenAsTheyWeigh) {
  LobeDistribution d;
  d.lobes = {{0.04, 0.04, 0.04, 1.0, 3.0}, {0.25, 0.25, 1.0, 1.0, 1.0}, {1e-9, 1e-9, 1.0, 1.0, 4.0}};
  std::map<double, int> counts;
  for (const LookUp& l : drawLookUps(d, 4000, 1e-4, 1)) {
    ++counts[l.parameters.alphaX];
    EXPECT_EQ(l.parameters.alphaX, l.parameters.alphaY);
    EXPECT_EQ(l.parameters.phi, 0.0);
    EXPECT_EQ(l.f0, l.parameters.alphaX == 0.04 ? 0.04 : 1.0);
  }
  EXPECT_EQ(counts.size(), 3u);
  // quasi-random: within a few of the share
  EXPECT_NEAR(counts[1e-4], 2000, 5);
  EXPECT_NEAR(counts[0.04], 1500, 5);
  EXPECT_NEAR(counts[0.25], 500, 5);
}

TEST(LobeDistribution, ViewsAreUniformOverTheirRange) {
  LobeDistribution d = test::anisotropicLobes();
  d.views = {0.3, 1.1};
  double theta = 0.0;
  double phi = 0.0;
  double product = 0.0;
  const int n = 4096;
  for (const LookUp& l : drawLookUps(d, n, 1e-4, 7)) {
    EXPECT_GE(l.parameters.theta, 0.3);
    EXPECT_LE(l.parameters.theta, 1.1);
    EXPECT_LE(l.parameters.phi, kHalfPi);
    theta += l.parameters.theta / n;
    phi += l.parameters.phi / n;
    product += (l.parameters.theta - 0.7) * (l.parameters.alphaX - 0.3) / n;
  }
  EXPECT_NEAR(theta, 0.7, 1e-3);
  EXPECT_NEAR(phi, 0.5 * kHalfPi, 2e-3);
  EXPECT_NEAR(product, 0.0, 1e-3);  // views do not go with lobes

  d = test::isotropicLobes(0.2, 0.6);
  double u = 0.0;
  for (const LookUp& l : drawLookUps(d, n, 1e-4, 7)) u += std::sqrt(1.0 - std::cos(l.parameters.theta)) / n;
  EXPECT_NEAR(u, 0.5, 1e-3);
}

TEST(LobeDistribution, SeedsGiveOtherPointsAndTheSameOneTheSame) {
  const LobeDistribution d = test::isotropicLobes(0.2, 0.6);
  const auto a = drawLookUps(d, 16, 1e-4, 1);
  const auto b = drawLookUps(d, 16, 1e-4, 1);
  const auto c = drawLookUps(d, 16, 1e-4, 2);
  int differ = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].parameters.theta, b[i].parameters.theta);
    differ += a[i].parameters.theta != c[i].parameters.theta ? 1 : 0;
  }
  EXPECT_EQ(differ, 16);
}

}  // namespace
}  // namespace ltcfit
