#include "report/smoothness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "export/read_table.h"

namespace ltcfit {
namespace {

constexpr std::size_t kNodes = 16;  // of each axis

Table smallIsotropic() {
  const Table full = readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_iso.json");
  TableInfo info = full.info();
  // of the table in data/, the last 16 nodes of alpha (0.56 to 1) and the first 16 of theta (0 to 19
  // degrees): wide, slow lobes
  std::vector<float> data;
  const std::size_t channels = full.channelCount();
  for (std::size_t t = 0; t < kNodes; ++t) {
    for (std::size_t a = 64 - kNodes; a < 64; ++a) {
      const auto from = full.data().begin() + static_cast<std::ptrdiff_t>((t * 64 + a) * channels);
      data.insert(data.end(), from, from + static_cast<std::ptrdiff_t>(channels));
    }
  }
  const auto cut = [](Axis& axis, std::size_t first) {
    const auto begin = axis.values.begin() + static_cast<std::ptrdiff_t>(first);
    axis.values = std::vector<double>(begin, begin + kNodes);
    axis.low = axis.values.front();
    axis.high = axis.values.back();
  };
  cut(info.axes[0], 0);
  cut(info.axes[1], 64 - kNodes);
  return Table(info, data);
}

Table changed(const Table& table, std::size_t node, const char* channel, float factor) {
  std::vector<float> data = table.data();
  const auto& channels = table.info().channels;
  const auto c = std::find(channels.begin(), channels.end(), channel) - channels.begin();
  data[node * channels.size() + static_cast<std::size_t>(c)] *= factor;
  return Table(table.info(), data);
}

TEST(Smoothness, AFittedTableMovesAsTheLobesDo) {
  const std::vector<AxisSmoothness> s = tableSmoothness(smallIsotropic(), 0);
  ASSERT_EQ(s.size(), 2u);
  EXPECT_EQ(s[0].axis, "theta");
  EXPECT_EQ(s[1].axis, "alpha");
  for (const AxisSmoothness& axis : s) {
    EXPECT_EQ(axis.summary.count, kNodes * (kNodes - 1));
    EXPECT_EQ(axis.summary.nonFinite, 0u);
    // the noise of 256 directions
    EXPECT_LT(axis.summary.max, 0.01) << axis.axis;
  }
  // no step leaves the last node of an axis
  EXPECT_TRUE(std::isnan(s[1].steps[kNodes - 1]));
  EXPECT_TRUE(std::isnan(s[0].steps[kNodes * kNodes - 1]));
  EXPECT_FALSE(std::isnan(s[0].steps[kNodes - 1]));
}

TEST(Smoothness, OneEntryThatIsOffStandsOut) {
  const std::size_t node = 5 * kNodes + 6;
  // a lobe a third too wide in the plane of incidence
  const std::vector<AxisSmoothness> s = tableSmoothness(changed(smallIsotropic(), node, "m00", 1.33f), 0);
  for (std::size_t a = 0; a < 2; ++a) {
    const std::size_t before = a == 0 ? node - kNodes : node - 1;
    EXPECT_GT(s[a].steps[before], 0.03);
    EXPECT_GT(s[a].steps[node], 0.03);
    for (std::size_t i = 0; i < s[a].steps.size(); ++i) {
      if (i != node && i != before && !std::isnan(s[a].steps[i])) {
        EXPECT_LT(s[a].steps[i], 0.01);
      }
    }
  }
}

TEST(Smoothness, MatricesThatDoNotInterpolateStandOut) {
  // the other sign of column 1 is the same lobe at the node, and a flat one half way to its neighbours
  const std::size_t node = 5 * kNodes + 6;
  const std::vector<AxisSmoothness> s = tableSmoothness(changed(smallIsotropic(), node, "m11", -1.0f), 0);
  for (std::size_t a = 0; a < 2; ++a) {
    EXPECT_GT(s[a].steps[node], 0.3);
    EXPECT_GT(s[a].steps[a == 0 ? node - kNodes : node - 1], 0.3);
  }
}

TEST(Smoothness, AStepThroughAMatrixWithoutInverseIsCounted) {
  const std::size_t node = 5 * kNodes + 6;
  const std::vector<AxisSmoothness> s = tableSmoothness(changed(smallIsotropic(), node, "m11", 0.0f), 0);
  EXPECT_EQ(s[0].summary.nonFinite, 2u);
  EXPECT_TRUE(std::isinf(s[1].steps[node]));
}

TEST(Smoothness, DoesNotDependOnThreads) {
  const Table table = smallIsotropic();
  const std::vector<AxisSmoothness> one = tableSmoothness(table, 1);
  const std::vector<AxisSmoothness> three = tableSmoothness(table, 3);
  for (std::size_t a = 0; a < 2; ++a) EXPECT_EQ(one[a].summary.mean, three[a].summary.mean);
}

}  // namespace
}  // namespace ltcfit
