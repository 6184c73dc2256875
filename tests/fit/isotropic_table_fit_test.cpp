#include "fit/isotropic_table_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ltc/ltc.h"

namespace ltcfit {
namespace {

IsotropicFitOptions smallOptions() {
  IsotropicFitOptions o;
  o.table.thetaNodes = 8;
  o.table.alphaNodes = 8;
  o.entry.samples = 256;
  return o;
}

TEST(IsotropicTableFit, GivesAUsableTable) {
  for (const char* axes : {"2016", "2017"}) {
    IsotropicFitOptions options = smallOptions();
    options.table.axes = isotropicPlacement(axes);
    const IsotropicFitResult r = fitIsotropicTable(options);
    EXPECT_EQ(r.unusable, 0u);
    EXPECT_EQ(r.notConverged, 0u);
    EXPECT_LT(r.largestMomentError, 1e-4);
    const Table table(r.info, r.data);
    for (std::size_t i = 0; i < table.nodeCount(); ++i) {
      const TableEntry e = table.entry(table.node(i));
      EXPECT_GT(e.m.determinant(), 0.0);
      EXPECT_TRUE(isInvertibleInFloat(e.m));
      EXPECT_NEAR(e.m.col(2).norm(), 1.0, 1e-6);
    }
    // normal view: isotropic about z
    for (std::size_t a = 0; a < 8; ++a) {
      const TableEntry e = table.entry(std::vector<std::size_t>{0, a});
      EXPECT_EQ(e.m(0, 0), e.m(1, 1));
      EXPECT_EQ(e.m(0, 2), 0.0);
    }
    EXPECT_EQ(table.parameters(std::vector<std::size_t>{7, 7}).theta, 0.5 * std::numbers::pi);
  }
}

TEST(IsotropicTableFit, DoesNotDependOnThreads) {
  IsotropicFitOptions options = smallOptions();
  options.threads = 1;
  const IsotropicFitResult one = fitIsotropicTable(options);
  for (int threads : {2, 3, 7}) {
    options.threads = threads;
    const IsotropicFitResult many = fitIsotropicTable(options);
    EXPECT_EQ(one.data, many.data) << threads;  // bit for bit
    EXPECT_EQ(one.evaluations, many.evaluations);
  }
}

TEST(IsotropicTableFit, TheSeedMatters) {
  IsotropicFitOptions options = smallOptions();
  const IsotropicFitResult a = fitIsotropicTable(options);
  options.entry.seed = 2;
  EXPECT_NE(a.data, fitIsotropicTable(options).data);
}

TEST(IsotropicTableFit, EntriesThatDidNotConvergeAreTriedAgainAndCounted) {
  IsotropicFitOptions options = smallOptions();
  options.entry.nelderMead.maxEvaluations = 6;
  const IsotropicFitResult r = fitIsotropicTable(options);
  EXPECT_GT(r.notConverged, 40u);
  EXPECT_GE(r.refitted, r.notConverged);
  EXPECT_GT(r.improvedByRefit, 0u);
  for (const EntryReport& e : r.reports) {
    EXPECT_TRUE(e.refitted || e.fit.termination == Termination::kConverged);
    EXPECT_LE(e.fit.evaluations, 6);
    EXPECT_GE(e.totalEvaluations, e.fit.evaluations);
  }
}

TEST(IsotropicTableFit, HopelessEntriesAreUnusable) {
  // one evaluation from warm starts that were never fitted: the sharp rows end worse than no light at all
  IsotropicFitOptions options = smallOptions();
  options.entry.nelderMead.maxEvaluations = 1;
  options.table.alphaFloor = 1e-5;
  const IsotropicFitResult r = fitIsotropicTable(options);
  EXPECT_GT(r.unusable, 0u);
  EXPECT_EQ(r.unusable,
            static_cast<std::size_t>(std::count_if(r.reports.begin(), r.reports.end(),
                                                   [](const EntryReport& e) { return !e.usable; })));
}

TEST(IsotropicTableFit, ReportsHowEachEntryBegan) {
  const IsotropicFitResult r = fitIsotropicTable(smallOptions());
  EXPECT_EQ(r.reports[7].warmStart, WarmStart::kIdentity);        // theta 0, alpha 1
  EXPECT_EQ(r.reports[6].warmStart, WarmStart::kAlphaNeighbour);  // theta 0
  EXPECT_EQ(r.reports[8 + 4].warmStart, WarmStart::kThetaNeighbour);
  for (const EntryReport& e : r.reports) EXPECT_LE(e.fit.cost, e.fit.startCost);
}

TEST(IsotropicTableFit, ProgressCountsEveryEntryOnce) {
  std::size_t calls = 0;
  std::size_t last = 0;
  fitIsotropicTable(smallOptions(), [&](std::size_t done, std::size_t total) {
    ++calls;
    last = done;
    EXPECT_EQ(total, 64u);
  });
  EXPECT_EQ(calls, 64u);
  EXPECT_EQ(last, 64u);
}

TEST(IsotropicFitOptions, AreChecked) {
  std::string error;
  EXPECT_TRUE(IsotropicFitOptions{}.isValid(&error));
  const auto refuses = [&](auto change, const std::string& part) {
    IsotropicFitOptions o;
    change(o);
    EXPECT_FALSE(o.isValid(&error));
    EXPECT_NE(error.find(part), std::string::npos) << error;
  };
  refuses([](IsotropicFitOptions& o) { o.table.thetaNodes = 1; }, "1 theta nodes");
  refuses([](IsotropicFitOptions& o) { o.table.alphaNodes = 0; }, "0 alpha nodes");
  refuses([](IsotropicFitOptions& o) { o.table.alphaFloor = -0.1; }, "--alpha-floor");
  refuses([](IsotropicFitOptions& o) { o.table.alphaFloor = std::nan(""); }, "--alpha-floor");
  refuses([](IsotropicFitOptions& o) { o.table.alphaFloor = 0.01; }, "second");
  refuses([](IsotropicFitOptions& o) { o.entry.samples = 0; }, "--samples 0");
  refuses([](IsotropicFitOptions& o) { o.threads = -1; }, "--threads");
}

}  // namespace
}  // namespace ltcfit
