// Tables made for a scene, axes of one node, warps, channels left out, through what judges tables.
#include <gtest/gtest.h>

#include <cmath>

#include "report/compare.h"
#include "report/score.h"
#include "report/smoothness.h"
#include "tests/support/tailored.h"

namespace ltcfit::test {
namespace {

TEST(TailoredReport, Scores) {
  for (const Tailored& t : tailoredTables()) {
    for (PointSet set : {PointSet::kNodes, PointSet::kOffGrid, PointSet::kExtreme}) {
      ScoreOptions options;
      options.set = set;
      options.count = 2;
      const Score score = scoreTables({&t.table}, options, {})[0];
      EXPECT_EQ(score.points,
                std::min<std::size_t>(2, t.table.nodeCount() + (set == PointSet::kNodes ? 0 : 1)))
          << t.name;
      EXPECT_EQ(score.singular, 0u) << t.name;
      EXPECT_GT(score.summary[static_cast<std::size_t>(Metric::kSw1)].mean, 0.0) << t.name;
      // interpolated at few nodes, but of the lobe that is meant
      EXPECT_LT(score.summary[static_cast<std::size_t>(Metric::kSw1)].max, 0.2) << t.name;
      const auto has = [&](const char* channel) {
        const std::vector<std::string>& c = t.table.info().channels;
        return std::find(c.begin(), c.end(), channel) != c.end();
      };
      EXPECT_EQ(score.summary[static_cast<std::size_t>(Metric::kAlbedoError)].count > 0, has("norm"))
          << t.name;
      EXPECT_EQ(score.summary[static_cast<std::size_t>(Metric::kFresnelError)].count > 0, has("fresnel"))
          << t.name;
    }
  }
}

TEST(TailoredReport, Compares) {
  for (const Tailored& t : tailoredTables()) {
    const TableDifference same = compareTables(t.table, t.table);
    EXPECT_TRUE(same.sameStorage) << t.name;
    EXPECT_EQ(same.sw1.max, 0.0) << t.name;
    EXPECT_GT(same.between.count, 0u) << t.name;
    EXPECT_EQ(same.between.max, 0.0) << t.name;
    const TableDifference other =
        compareTables(t.table, tailoredTable(t.table.isIsotropic() ? "isoFull" : "anisoFull"));
    EXPECT_EQ(other.sameNodes, t.name == "isoFull" || t.name == "anisoFull");
    EXPECT_LT(other.sw1.max, 1e-3) << t.name;  // its nodes are look-ups of that
  }
  // where its nodes are is part of a table
  TableInfo info = tailoredTable("isoRange").info();
  info.axes[1] = alphaAxis(AxisMap::kSqrt, 11, 0.09, 0.49);
  EXPECT_FALSE(
      compareTables(Table(info, tailoredTable("isoRange").data()), tailoredTable("isoRange")).sameNodes);
}

TEST(TailoredReport, Smoothness) {
  for (const Tailored& t : tailoredTables()) {
    if (t.name == "isoFull" || t.name == "anisoFull") continue;
    const std::vector<AxisSmoothness> axes = tableSmoothness(t.table, 0);
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const std::size_t n = t.table.info().axes[a].size();
      EXPECT_EQ(axes[a].summary.count, t.table.nodeCount() / n * (n - 1)) << t.name << axes[a].axis;
    }
  }
}

}  // namespace
}  // namespace ltcfit::test
