#include "ltc/table.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace ltcfit {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

TableInfo smallInfo() {
  TableInfo info;
  info.axes = {makeAxis("theta", "rad", AxisMap::kLinear, 3, 0.0, kHalfPi),
               makeAxis("alpha", "1", AxisMap::kSqrt, 2, 0.0, 1.0, 1e-4)};
  info.channels = {"m00", "m02", "m11", "m20", "m22", "norm", "fresnel"};
  info.alphaFloor = 1e-4;
  return info;
}

std::vector<float> smallData() {
  std::vector<float> data;
  for (int i = 0; i < 6; ++i) {
    const float v = static_cast<float>(i);
    data.insert(data.end(), {1.0f + v, 0.1f * v, 2.0f, -0.1f * v, 1.0f, 0.5f + 0.01f * v, 0.02f * v});
  }
  return data;
}

std::string messageOf(const TableInfo& info, const std::vector<float>& data) {
  try {
    Table(info, data);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Table, IndicesAndParameters) {
  const Table table(smallInfo(), smallData());
  EXPECT_EQ(table.nodeCount(), 6u);
  const std::size_t node[2] = {2, 1};
  EXPECT_EQ(table.index(node), 5u * 7u);
  EXPECT_EQ(table.node(5), (std::vector<std::size_t>{2, 1}));
  const LobeParameters p = table.parameters(node);
  EXPECT_EQ(p.theta, kHalfPi);
  EXPECT_EQ(p.alphaX, 1.0);
  const std::size_t first[2] = {0, 0};
  EXPECT_EQ(table.parameters(first).alphaX, 1e-4);
  EXPECT_EQ(table.parameters(first).alphaY, 1e-4);
}

TEST(Table, EntriesAndFetchesAgreeAtNodes) {
  const Table table(smallInfo(), smallData());
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    const auto node = table.node(i);
    // alpha of texel 0 is 0 for the shader, though the node was fitted at the floor
    const double alpha = node[1] == 0 ? 0.0 : 1.0;
    const TableEntry stored = table.entry(node);
    const TableEntry fetched = table.fetch({alpha, alpha, table.parameters(node).theta, 0.0});
    EXPECT_LT((stored.m - fetched.m).norm(), 1e-6);
    EXPECT_NEAR(*stored.norm, *fetched.norm, 1e-6);
    EXPECT_LT((stored.m * stored.mInv - Eigen::Matrix3d::Identity()).norm(), 1e-6);
    EXPECT_TRUE(stored.invertible);
  }
}

TEST(Table, AnAxisMayHaveOneNode) {
  TableInfo info = smallInfo();
  info.axes[1] = singleNodeAxis("alpha", "1", 0.25);
  std::vector<float> data = smallData();
  data.resize(3 * 7);
  const Table row(info, data);
  const double theta = kHalfPi / 4.0;
  for (double alpha : {0.01, 0.25, 1.0}) {
    EXPECT_NEAR(row.fetch({alpha, alpha, theta, 0.0}).m(0, 0), 0.5 * (1.0 + 2.0), 1e-6);
  }
  info.axes[1].map = AxisMap::kSqrt;
  EXPECT_EQ(messageOf(info, data), "axis 'alpha' has one value, and can have no map");
}

TEST(Table, WarpedAxes) {
  TableInfo info = smallInfo();
  info.axes[0] = makeAxis("theta", "rad", AxisMap::kLinear, 3, 0.0, kHalfPi, 0.0, {0.5, 0.0});
  const Table table(info, smallData());
  EXPECT_LT(info.axes[0].values[1], kHalfPi / 2.0);
  const std::size_t node[2] = {1, 1};
  const TableEntry e = table.fetch({1.0, 1.0, info.axes[0].values[1], 0.0});
  EXPECT_NEAR(e.m(0, 0), table.entry(node).m(0, 0), 1e-6);
  // nodes that lie elsewhere than the warp says, and one that folds
  info.axes[0].warp = {-0.5, 0.0};
  EXPECT_EQ(messageOf(info, smallData()), "axis 'theta' values[1] is not where its map 'linear' puts it");
  info.axes[0].warp = {2.0, 0.0};
  EXPECT_EQ(messageOf(info, smallData()),
            "axis 'theta' warp: (2.000000, 0.000000) leaves nodes too far apart (ltc/axis.h)");
}

TEST(Table, FetchIsBilinearInTheMappedCoordinates) {
  const Table table(smallInfo(), smallData());
  // halfway in theta between rows 0 and 1, sqrt(alpha) = 1/4 of the way
  const TableEntry e = table.fetch({1.0 / 16.0, 1.0 / 16.0, kHalfPi / 4.0, 0.0});
  const double row0 = 1.0 * 0.75 + 2.0 * 0.25;
  const double row1 = 3.0 * 0.75 + 4.0 * 0.25;
  EXPECT_NEAR(e.m(0, 0), 0.5 * (row0 + row1), 1e-6);
  EXPECT_EQ(e.m(0, 1), 0.0);
}

TEST(Table, InverseStorageIsInterpolatedAsStored) {
  TableInfo info = smallInfo();
  info.stores = MatrixStorage::kMinv;
  const Table table(info, smallData());
  const TableEntry e = table.fetch({1.0 / 16.0, 1.0 / 16.0, 0.0, 0.0});
  EXPECT_NEAR(e.mInv(0, 0), 1.25, 1e-6);
  EXPECT_NEAR(e.m(0, 0) * e.mInv(0, 0) + e.m(0, 2) * e.mInv(2, 0), 1.0, 1e-6);
}

TEST(Table, ASingularEntryIsToldNotHidden) {
  std::vector<float> data = smallData();
  data[0] = 0.0f;  // m00 of the first node, whose m02 and m20 are 0
  const Table table(smallInfo(), data);
  EXPECT_FALSE(table.entry(std::vector<std::size_t>{0, 0}).invertible);
}

TEST(Table, Normalizations) {
  Eigen::Matrix3d m;
  m << 2, 0, 3, 0, 5, 0, 1, 0, 4;
  EXPECT_NEAR(normalized(m, MatrixNormalization::kThirdColumnUnit).col(2).norm(), 1.0, 1e-15);
  EXPECT_EQ(normalized(m, MatrixNormalization::kMiddleElement)(1, 1), 1.0);
  EXPECT_EQ(normalized(m, MatrixNormalization::kNone), m);
  for (auto n : {MatrixNormalization::kNone, MatrixNormalization::kThirdColumnUnit,
                 MatrixNormalization::kMiddleElement}) {
    EXPECT_EQ(matrixNormalizationFromName(matrixNormalizationName(n)), n);
  }
  EXPECT_THROW(matrixNormalizationFromName("unit"), std::invalid_argument);
  EXPECT_THROW(matrixStorageFromName("m"), std::invalid_argument);
}

TEST(Table, AnisotropicLookUp) {
  TableInfo info;
  for (const char* name : {"alpha", "lambda"})
    info.axes.push_back(makeAxis(name, "1", AxisMap::kLinear, 2, 0.0, 1.0));
  for (const char* name : {"theta", "phi"})
    info.axes.push_back(makeAxis(name, "rad", AxisMap::kLinear, 2, 0.0, kHalfPi));
  info.channels = {"m00", "m11", "m22"};
  info.alphaFloor = 1e-4;
  std::vector<float> data;
  for (int i = 0; i < 16; ++i) data.insert(data.end(), {static_cast<float>(i + 1), 1.0f, 1.0f});
  const Table table(info, data);
  EXPECT_FALSE(table.isIsotropic());
  // weights of the axes in the corner numbers: alpha 8, lambda 4, theta 2, phi 1
  EXPECT_NEAR(table.fetch({0.5, 0.125, kHalfPi * 0.5, kHalfPi * 0.25}).m(0, 0), 1 + 4 + 1 + 1 + 0.25, 1e-6);
  const LobeParameters p = table.parameters(std::vector<std::size_t>{1, 0, 1, 1});
  EXPECT_EQ(p.alphaX, 1.0);
  EXPECT_EQ(p.alphaY, 1e-4);
  EXPECT_FALSE(table.fetch({0.5, 0.1, 0.1, 0.1}).norm.has_value());
}

TEST(Table, RefusesWhatIsNotATable) {
  const TableInfo good = smallInfo();
  const std::vector<float> data = smallData();
  EXPECT_EQ(messageOf(good, data), "accepted");
  const auto expectMessage = [&](const std::string& part, auto change, std::vector<float> numbers) {
    TableInfo info = good;
    change(info);
    EXPECT_NE(messageOf(info, numbers).find(part), std::string::npos) << messageOf(info, numbers);
  };
  expectMessage("data: 41 numbers", [](TableInfo&) {}, {data.begin(), data.end() - 1});
  expectMessage(
      "axes: need", [](TableInfo& i) { i.axes.pop_back(); }, data);
  expectMessage(
      "axes: need", [](TableInfo& i) { std::swap(i.axes[0], i.axes[1]); }, data);
  expectMessage(
      "does not increase", [](TableInfo& i) { i.axes[0].values[2] = i.axes[0].values[1]; }, data);
  expectMessage(
      "is outside of", [](TableInfo& i) { i.axes[1].values[0] = -0.1; }, data);
  expectMessage(
      "is outside of", [](TableInfo& i) { i.axes[1].values[1] = 1.5; }, data);
  expectMessage(
      "is not finite", [](TableInfo& i) { i.axes[1].values[0] = std::nan(""); }, data);
  expectMessage(
      "is not where its map", [](TableInfo& i) { i.axes[0].values[1] *= 1.1; }, data);
  expectMessage(
      "range", [](TableInfo& i) { i.axes[0].high = i.axes[0].low; }, data);
  expectMessage(
      "0 values", [](TableInfo& i) { i.axes[1].values.clear(); }, data);
  expectMessage(
      "one value", [](TableInfo& i) { i.axes[1].values.pop_back(); }, data);
  expectMessage(
      "unknown name 'm33'", [](TableInfo& i) { i.channels[0] = "m33"; }, data);
  expectMessage(
      "occurs twice", [](TableInfo& i) { i.channels[1] = "m00"; }, data);
  expectMessage(
      "needs m00, m11 and m22", [](TableInfo& i) { i.channels[4] = "m21"; }, data);
  expectMessage(
      "alpha_floor", [](TableInfo& i) { i.alphaFloor = -1.0; }, data);
  std::vector<float> bad = data;
  bad[8] = std::numeric_limits<float>::infinity();
  expectMessage(
      "theta[0], alpha[1], m02 is not finite", [](TableInfo&) {}, bad);
}

TEST(Table, AnAbsurdSizeIsRefusedBeforeItIsMultiplied) {
  // four axes of 65536 nodes: their product is 2^64, which wraps to 0 and would fit an empty data array
  TableInfo info;
  for (const char* name : {"alpha", "lambda"})
    info.axes.push_back(makeAxis(name, "1", AxisMap::kLinear, 65536, 0.0, 1.0));
  for (const char* name : {"theta", "phi"})
    info.axes.push_back(makeAxis(name, "rad", AxisMap::kLinear, 65536, 0.0, kHalfPi));
  info.channels = {"m00", "m11", "m22"};
  EXPECT_NE(messageOf(info, {}).find("nodes"), std::string::npos);
}

}  // namespace
}  // namespace ltcfit
