#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "ltc/symmetry.h"
#include "ltc/table.h"

namespace ltcfit {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

Axis knots(const char* name, const char* unit, std::vector<double> values) {
  return {name, unit, std::move(values), AxisMap::kNone, 0.0, 0.0, {}};
}

// Full and partial, warped, of knots, of one node.
std::vector<std::vector<Axis>> axesOfTables() {
  using enum AxisMap;
  const Axis one = singleNodeAxis("theta", "rad", 0.4);
  return {{makeAxis("theta", "rad", kSqrtOneMinusCos, 5, 0.0, kHalfPi),
           makeAxis("alpha", "1", kSqrt, 4, 0.0, 1.0, 1e-4)},
          {makeAxis("theta", "rad", kLinear, 3, 0.2, 1.1, 0.0, {0.4, -0.2}),
           knots("alpha", "1", {0.1, 0.15, 0.6})},
          {one, makeAxis("alpha", "1", kLinear, 4, 0.0, 1.0)},
          {one, singleNodeAxis("alpha", "1", 0.3)},
          {makeAxis("alpha", "1", kSqrt, 3, 0.0, 1.0, 1e-4, {0.5, 0.2}),
           makeAxis("lambda", "1", kLinear, 4, 0.0, 1.0), makeAxis("theta", "rad", kLinear, 3, 0.0, kHalfPi),
           makeAxis("phi", "rad", kLinear, 2, 0.0, kHalfPi)},
          {knots("alpha", "1", {0.1, 0.5, 0.6}), singleNodeAxis("lambda", "1", 0.5),
           knots("theta", "rad", {0.1, 1.5}), makeAxis("phi", "rad", kLinear, 3, 0.3, 1.2)},
          {singleNodeAxis("alpha", "1", 0.1), singleNodeAxis("lambda", "1", 0.5), one,
           singleNodeAxis("phi", "rad", 0.2)}};
}

Table randomTable(std::vector<Axis> axes, std::mt19937& random) {
  TableInfo info;
  info.axes = std::move(axes);
  info.channels = {"m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22", "norm", "fresnel"};
  std::size_t count = info.channels.size();
  for (const Axis& axis : info.axes) count *= axis.size();
  std::uniform_real_distribution<float> uniform(0.1f, 1.0f);
  std::vector<float> data(count);
  for (float& x : data) x = uniform(random);
  return Table(info, data);
}

// alphaX >= alphaY, phi in the first quadrant: also outside of partial axes.
LobeParameters randomLobe(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double alpha = uniform(random);
  return {alpha, alpha * uniform(random), kHalfPi * uniform(random), kHalfPi * uniform(random)};
}

TEST(LookUpNodes, AreThoseOfTheFetch) {
  std::mt19937 random(1);
  for (const std::vector<Axis>& axes : axesOfTables()) {
    const Table table = randomTable(axes, random);
    for (int i = 0; i < 300; ++i) {
      const LobeParameters p = randomLobe(random);
      const LookUpNodes nodes = lookUpNodes(axes, p);
      ASSERT_GE(nodes.count, 1u);
      ASSERT_LE(nodes.count, std::size_t{1} << axes.size());
      double sum = 0.0;
      TableEntry expected{Eigen::Matrix3d::Zero(), {}, false, 0.0, 0.0};
      for (std::size_t k = 0; k < nodes.count; ++k) {
        ASSERT_LT(nodes.node[k], table.nodeCount());
        EXPECT_GT(nodes.weight[k], 0.0);
        for (std::size_t other = 0; other < k; ++other) EXPECT_NE(nodes.node[other], nodes.node[k]);
        sum += nodes.weight[k];
        const TableEntry entry = table.entry(table.node(nodes.node[k]));
        expected.m += nodes.weight[k] * entry.m;
        *expected.norm += nodes.weight[k] * *entry.norm;
      }
      EXPECT_NEAR(sum, 1.0, 1e-14);
      // the same sums
      const TableEntry fetched = table.fetch(p);
      EXPECT_LT((fetched.m - expected.m).norm(), 1e-14);
      EXPECT_NEAR(*fetched.norm, *expected.norm, 1e-14);
    }
  }
}

TEST(LookUpNodes, InterpolateTheParametersThemselves) {
  // multilinear interpolation of linear axes gives their coordinates back: written out here
  const std::vector<Axis> axes{makeAxis("alpha", "1", AxisMap::kLinear, 3, 0.0, 1.0),
                               makeAxis("lambda", "1", AxisMap::kLinear, 4, 0.0, 1.0),
                               makeAxis("theta", "rad", AxisMap::kLinear, 3, 0.0, kHalfPi),
                               knots("phi", "rad", {0.0, 0.2, 1.0, kHalfPi})};
  std::mt19937 random(2);
  for (int i = 0; i < 300; ++i) {
    const LobeParameters p = randomLobe(random);
    const LookUpNodes nodes = lookUpNodes(axes, p);
    double value[4] = {};
    for (std::size_t k = 0; k < nodes.count; ++k) {
      std::size_t flat = nodes.node[k];
      for (std::size_t a = 4; a-- > 0; flat /= axes[a].size())
        value[a] += nodes.weight[k] * axes[a].values[flat % axes[a].size()];
    }
    EXPECT_NEAR(value[0], p.alphaX, 1e-14);
    EXPECT_NEAR(value[1], p.alphaY / p.alphaX, 1e-14);
    EXPECT_NEAR(value[2], p.theta, 1e-14);
    EXPECT_NEAR(value[3], p.phi, 1e-14);
  }
}

TEST(LookUpNodes, AreTheNodeAloneAtANode) {
  const std::vector<Axis> axes{knots("alpha", "1", {0.25, 0.5, 1.0}), knots("lambda", "1", {0.25, 0.5, 1.0}),
                               knots("theta", "rad", {0.0, 0.5, kHalfPi}),
                               knots("phi", "rad", {0.0, kHalfPi})};
  for (std::size_t n = 0; n < 54; ++n) {
    const double alpha = axes[0].values[n / 18];
    const LookUpNodes nodes = lookUpNodes(
        axes, {alpha, alpha * axes[1].values[n / 6 % 3], axes[2].values[n / 2 % 3], axes[3].values[n % 2]});
    ASSERT_EQ(nodes.count, 1u) << n;
    EXPECT_EQ(nodes.node[0], n);
    EXPECT_EQ(nodes.weight[0], 1.0);
  }
}

TEST(LookUpNodes, AreClampedToTheAxes) {
  const std::vector<Axis> axes{makeAxis("theta", "rad", AxisMap::kLinear, 3, 0.3, 0.9),
                               makeAxis("alpha", "1", AxisMap::kSqrt, 4, 0.1, 0.6)};
  const LookUpNodes below = lookUpNodes(axes, {0.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(below.count, 1u);
  EXPECT_EQ(below.node[0], 0u);
  const LookUpNodes above = lookUpNodes(axes, {1.0, 1.0, kHalfPi, 0.0});
  EXPECT_EQ(above.count, 1u);
  EXPECT_EQ(above.node[0], 11u);
}

}  // namespace
}  // namespace ltcfit
