#include "ltc/resample.h"

#include <gtest/gtest.h>

#include <stdexcept>

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

}  // namespace
}  // namespace ltcfit
