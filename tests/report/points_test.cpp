#include "report/points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

#include "tests/support/small_table.h"

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

TEST(Points, Names) {
  for (PointSet set : {PointSet::kNodes, PointSet::kOffGrid, PointSet::kExtreme}) {
    EXPECT_EQ(pointSetFromName(pointSetName(set)), set);
  }
  EXPECT_THROW(pointSetFromName("everywhere"), std::invalid_argument);
}

}  // namespace
}  // namespace ltcfit
