#include "ltc/resample.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>
#include <string>

#include "tests/support/small_table.h"

namespace ltcfit {
namespace {

TEST(Resample, TheSameNodesGiveTheSameNumbers) {
  const Table table = test::smallTable();
  TableInfo info = table.info();
  info.normalization = MatrixNormalization::kNone;  // the numbers of this table are not scaled to anything
  const Table plain(info, table.data());
  const Table same = resampled(plain, info.axes);
  for (std::size_t i = 0; i < plain.data().size(); ++i) EXPECT_FLOAT_EQ(same.data()[i], plain.data()[i]);
}

TEST(Resample, NewNodesAreLookUps) {
  const Table table = test::smallTable();
  const Table finer = resampled(table, {makeAxis("theta", "rad", AxisMap::kLinear, 5, 0.0, 1.5),
                                        makeAxis("alpha", "1", AxisMap::kLinear, 6, 0.0, 1.0, 1e-4)});
  for (std::size_t i = 0; i < finer.nodeCount(); ++i) {
    const auto node = finer.node(i);
    const double alpha = static_cast<double>(node[1]) / 5;
    const TableEntry a = finer.entry(node);
    const TableEntry b = table.fetch({alpha, alpha, 1.5 * static_cast<double>(node[0]) / 4, 0.0});
    EXPECT_LT((a.m - b.m / b.m.col(2).norm()).norm(), 1e-6);
    EXPECT_NEAR(*a.norm, *b.norm, 1e-6);
  }
}

TEST(Resample, OtherKindsAreRefused) {
  const Table table = test::smallTable();
  EXPECT_THROW(resampled(table, {table.info().axes[0]}), std::invalid_argument);
  EXPECT_THROW(resampled(table, {table.info().axes[1], table.info().axes[0]}), std::invalid_argument);
}

std::string messageOf(const Table& table, std::vector<Axis> axes) {
  try {
    resampled(table, std::move(axes));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Resample, NothingIsInventedBeyondTheAxes) {
  const Axis theta = makeAxis("theta", "rad", AxisMap::kLinear, 4, 0.2, 1.2);
  const Axis alpha = makeAxis("alpha", "1", AxisMap::kSqrt, 5, 0.09, 0.49, 0.0, {0.3, 0.1});
  const Table range = resampled(test::smallTable(), {theta, alpha});
  EXPECT_EQ(messageOf(range, {theta, makeAxis("alpha", "1", AxisMap::kLinear, 3, 0.1, 0.49)}), "");
  EXPECT_EQ(messageOf(range, {singleNodeAxis("theta", "rad", 0.2), alpha}), "");
  EXPECT_NE(
      messageOf(range, {theta, makeAxis("alpha", "1", AxisMap::kSqrt, 5, 0.09, 0.5)}).find("axis 'alpha'"),
      std::string::npos);
  EXPECT_NE(messageOf(range, {singleNodeAxis("theta", "rad", 0.19), alpha}).find("axis 'theta'"),
            std::string::npos);
  const Table row = resampled(range, {theta, singleNodeAxis("alpha", "1", 0.25)});
  EXPECT_EQ(messageOf(row, {theta, singleNodeAxis("alpha", "1", 0.25)}), "");
  EXPECT_NE(messageOf(row, {theta, alpha}).find("axis 'alpha' goes from 0.25 to 0.25"), std::string::npos);
}

TEST(Resample, AClampedFitReachesTheEnds) {
  TableInfo info = test::smallTable().info();
  for (Axis& axis : info.axes) {
    axis.map = AxisMap::kNone;
    axis.low = axis.high = 0.0;
  }
  info.axes[0].values.back() = 1.57;
  EXPECT_EQ(reachOf(info, 0).high, 0.5 * std::numbers::pi);
  EXPECT_EQ(reachOf(info, 1).low, 0.0);  // the floor
  info.axes[0].values.back() = 1.5;
  EXPECT_EQ(reachOf(info, 0).high, 1.5);
  info.alphaFloor = 0.0;
  EXPECT_EQ(reachOf(info, 1).low, 1e-4);
}

}  // namespace
}  // namespace ltcfit
