#include "report/compare.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "tests/support/small_table.h"

namespace ltcfit {
namespace {

Table changed(std::size_t at, float by) {
  std::vector<float> data = test::smallTable().data();
  data[at] += by;
  return Table(test::smallTable().info(), data);
}

TEST(Compare, EqualTablesHaveNoDifference) {
  const TableDifference d = compareTables(test::smallTable(), test::smallTable());
  EXPECT_TRUE(d.sameNodes);
  EXPECT_TRUE(d.sameStorage);
  for (const ChannelDifference& c : d.channels) EXPECT_EQ(c.different, 0u);
  EXPECT_EQ(d.sw1.count, 12u);
  EXPECT_EQ(d.sw1.max, 0.0);
  EXPECT_EQ(d.norm.max, 0.0);
}

TEST(Compare, FindsTheOneNumberThatDiffers) {
  const TableDifference matrix = compareTables(test::smallTable(), changed(7 * 5 + 2, 0.3f));
  EXPECT_EQ(matrix.channels[2].different, 1u);
  EXPECT_NEAR(matrix.channels[2].largest, 0.3, 1e-6);
  EXPECT_EQ(matrix.worstNode, 5u);
  EXPECT_GT(matrix.sw1.max, 0.01);
  EXPECT_EQ(matrix.norm.max, 0.0);
  const TableDifference norm = compareTables(test::smallTable(), changed(7 * 3 + 5, 0.01f));
  EXPECT_NEAR(norm.norm.max, 0.01, 1e-6);
  EXPECT_EQ(norm.sw1.max, 0.0);
}

TEST(Compare, TheSameLobesStoredOtherwise) {
  const Table inverse =
      storedAs(test::smallTable(), MatrixStorage::kMinv, MatrixNormalization::kMiddleElement);
  const TableDifference d = compareTables(test::smallTable(), inverse);
  EXPECT_TRUE(d.sameNodes);
  EXPECT_FALSE(d.sameStorage);
  EXPECT_TRUE(d.channels.empty());
  EXPECT_LT(d.sw1.max, 1e-6);
}

TEST(Compare, AShiftOfTheLobeIsItsDistance) {
  // a narrow lobe turned by a small angle in the x-z plane moves every direction by about that angle: its
  // projections on average by the mean of |cos| over the sphere's great circle, between 0 and the angle
  TableInfo info = test::smallTable().info();
  info.channels = {"m00", "m02", "m11", "m20", "m22"};
  const auto table = [&](double angle) {
    const Eigen::Matrix3d m = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix() *
                              Eigen::Vector3d(0.02, 0.02, 1.0).asDiagonal();
    std::vector<float> data;
    for (int i = 0; i < 12; ++i)
      for (const auto& [r, c] : {std::pair<int, int>{0, 0}, {0, 2}, {1, 1}, {2, 0}, {2, 2}})
        data.push_back(static_cast<float>(m(r, c)));
    return Table(info, data);
  };
  // tangents of a lobe at z: the projection moves by angle * |x of the projection|, whose mean over a half
  // sphere is 1/2
  EXPECT_NEAR(compareTables(table(0.0), table(0.01)).sw1.mean, 0.005, 0.0005);
}

TEST(Compare, OtherNodesAreLookedUp) {
  TableInfo info = test::smallTable().info();
  info.axes[1] = makeAxis("alpha", "1", AxisMap::kLinear, 4, 0.0, 1.0, 1e-4);
  const TableDifference d = compareTables(test::smallTable(), Table(info, test::smallTable().data()));
  EXPECT_FALSE(d.sameNodes);
  EXPECT_GT(d.sw1.max, 0.0);
}

}  // namespace
}  // namespace ltcfit
