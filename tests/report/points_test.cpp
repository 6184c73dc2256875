#include "report/points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

#include "ggx/random.h"
#include "tests/support/small_table.h"
#include "tests/support/tailored.h"

namespace ltcfit {
namespace {

Table anisotropicTable() {
  TableInfo info;
  for (const char* name : {"alpha", "lambda"})
    info.axes.push_back(makeAxis(name, "1", AxisMap::kLinear, 2, 0.0, 1.0));
  for (const char* name : {"theta", "phi"}) {
    info.axes.push_back(makeAxis(name, "rad", AxisMap::kLinear, 2, 0.0, 0.5 * std::numbers::pi));
  }
  info.channels = {"m00", "m11", "m22"};
  return Table(info, std::vector<float>(48, 1.0f));
}

TEST(Points, NodesAreDrawnWithoutRepetition) {
  const Table table = test::smallTable();
  EXPECT_EQ(makePoints(table, PointSet::kNodes, 0, 0.0, 1).size(), 12u);
  EXPECT_EQ(makePoints(table, PointSet::kNodes, 99, 0.0, 1).size(), 12u);
  const std::vector<Point> some = makePoints(table, PointSet::kNodes, 5, 0.0, 1);
  std::set<std::size_t> seen;
  for (const Point& p : some) {
    seen.insert(p.node.value());
    EXPECT_EQ(p.parameters.theta, table.parameters(table.node(*p.node)).theta);
  }
  EXPECT_EQ(seen.size(), 5u);
  const std::vector<Point> other = makePoints(table, PointSet::kNodes, 5, 0.0, 2);
  EXPECT_FALSE(std::equal(some.begin(), some.end(), other.begin(),
                          [](const Point& a, const Point& b) { return a.node == b.node; }));
}

TEST(Points, SharpOnesCanBeLeftOut) {
  for (const Point& p : makePoints(test::smallTable(), PointSet::kNodes, 0, 0.1, 1))
    EXPECT_GE(p.parameters.alphaX, 0.1);
  for (const Point& p : makePoints(test::smallTable(), PointSet::kOffGrid, 50, 0.5, 1))
    EXPECT_GE(p.parameters.alphaX, 0.5);
  EXPECT_TRUE(makePoints(test::smallTable(), PointSet::kExtreme, 5, 0.9, 1).empty());
}

TEST(Points, IsotropicIntervals) {
  const Table table = test::smallTable();
  for (PointSet set : {PointSet::kOffGrid, PointSet::kExtreme}) {
    const bool extreme = set == PointSet::kExtreme;
    double low = 1.0, high = 0.0;
    for (const Point& p : makePoints(table, set, 500, 0.0, 1)) {
      const double root = std::sqrt(p.parameters.alphaX);
      EXPECT_GE(root, extreme ? 0.01 : 0.05);
      EXPECT_LE(root, extreme ? 0.21 : 1.0);
      const double angle = std::sqrt(1.0 - std::cos(p.parameters.theta));
      EXPECT_GE(angle, (extreme ? 0.97 : 0.0) - 1e-12);
      EXPECT_LE(angle, 1.0 + 1e-12);
      low = std::min(low, angle);
      high = std::max(high, angle);
      EXPECT_EQ(p.parameters.alphaX, p.parameters.alphaY);
    }
    EXPECT_LT(low, extreme ? 0.971 : 0.02);  // the interval is filled
    EXPECT_GT(high, 0.98);
  }
}

TEST(Points, AnisotropicIntervals) {
  const Table table = anisotropicTable();
  for (const Point& p : makePoints(table, PointSet::kExtreme, 200, 0.0, 1)) {
    const double lambda = p.parameters.alphaY / p.parameters.alphaX;
    EXPECT_GE(lambda, 0.02);
    EXPECT_LE(lambda, 0.2 + 1e-12);
    EXPECT_GE(p.parameters.theta, 0.85 * 0.5 * std::numbers::pi);
  }
  for (const Point& p : makePoints(table, PointSet::kOffGrid, 200, 0.0, 1)) {
    EXPECT_GE(p.parameters.alphaX, 0.03);
    EXPECT_GE(p.parameters.alphaY, 0.05 * p.parameters.alphaX * (1 - 1e-12));
    EXPECT_LE(p.parameters.alphaY, p.parameters.alphaX);
  }
}

// Bit for bit: figures of tables that were published with them stay.
TEST(Points, FullTablesHaveThePointsThatTheyAlwaysHad) {
  Random random(mixSeed(1, 5));
  for (const Point& p : makePoints(test::smallTable(), PointSet::kOffGrid, 100, 0.0, 1)) {
    const double root = 0.05 + random.uniform() * (1.0 - 0.05);
    EXPECT_EQ(p.parameters.alphaX, root * root);
    EXPECT_EQ(p.parameters.theta, unmapCoordinate(AxisMap::kSqrtOneMinusCos, random.uniform()));
  }
  Random other(mixSeed(1, 5));
  for (const Point& p : makePoints(anisotropicTable(), PointSet::kExtreme, 100, 0.0, 1)) {
    const double alpha = 0.03 + other.uniform() * (1.0 - 0.03);
    const double lambda = 0.02 + other.uniform() * (0.2 - 0.02);
    EXPECT_EQ(p.parameters.alphaX, alpha);
    EXPECT_EQ(p.parameters.alphaY, alpha * lambda);
    EXPECT_EQ(p.parameters.theta, 0.5 * std::numbers::pi * (0.85 + other.uniform() * (1.0 - 0.85)));
    EXPECT_EQ(p.parameters.phi, 0.5 * std::numbers::pi * other.uniform());
  }
}

TEST(Points, StayWhereATableIsMeant) {
  for (const test::Tailored& t : test::tailoredTables()) {
    const std::vector<Axis>& axes = t.table.info().axes;
    for (PointSet set : {PointSet::kOffGrid, PointSet::kExtreme}) {
      const std::vector<Point> points = makePoints(t.table, set, 50, 0.0, 1);
      ASSERT_EQ(points.size(), 50u) << t.name;
      for (const Point& p : points) {
        const LobeParameters& q = p.parameters;
        const std::vector<double> at = t.table.isIsotropic()
                                           ? std::vector{q.theta, q.alphaX}
                                           : std::vector{q.alphaX, q.alphaY / q.alphaX, q.theta, q.phi};
        for (std::size_t a = 0; a < axes.size(); ++a) {
          // rounding of the maps and of alpha_y / alpha_x
          EXPECT_GE(at[a], axes[a].values.front() - 1e-12) << t.name << ' ' << axes[a].name;
          EXPECT_LE(at[a], axes[a].values.back() + 1e-12) << t.name << ' ' << axes[a].name;
        }
      }
    }
  }
  // sharp and grazing as far as it goes
  for (const Point& p : makePoints(test::tailoredTable("isoRange"), PointSet::kExtreme, 10, 0.0, 1)) {
    EXPECT_NEAR(p.parameters.alphaX, 0.09, 1e-12);
    EXPECT_NEAR(p.parameters.theta, 1.3, 1e-12);
  }
}

TEST(Points, Names) {
  for (PointSet set : {PointSet::kNodes, PointSet::kOffGrid, PointSet::kExtreme}) {
    EXPECT_EQ(pointSetFromName(pointSetName(set)), set);
  }
  EXPECT_THROW(pointSetFromName("everywhere"), std::invalid_argument);
}

}  // namespace
}  // namespace ltcfit
