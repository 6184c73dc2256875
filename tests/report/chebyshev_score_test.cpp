// What README states of the polynomials' errors against the lobes.
#include <gtest/gtest.h>

#include "export/chebyshev_file.h"
#include "export/read_table.h"
#include "report/score.h"

namespace ltcfit {
namespace {

double ratio(const std::vector<Score>& scores, Metric metric, double Summary::*of) {
  const auto m = static_cast<std::size_t>(metric);
  return scores[1].summary[m].*of / scores[0].summary[m].*of;
}

std::vector<Score> scoresOf(const Table& table, std::size_t coefficients, PointSet set) {
  ChebyshevOptions fit;
  fit.coefficients = coefficients;
  fit.round = roundToHalfPrecision;
  const Table expanded = tableOfChebyshev(fitChebyshev(table, fit));
  ScoreOptions options;
  options.set = set;
  options.count = 300;
  options.metrics.samples = 64;
  options.metrics.directions = 2;
  return scoreTables({&table, &expanded}, options);
}

TEST(ChebyshevScore, AThirdOfAKilobyteHasTheErrorOfTheTable) {
  const Table table = readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_iso.json");
  const std::vector<Score> offGrid = scoresOf(table, ChebyshevOptions().coefficients, PointSet::kOffGrid);
  EXPECT_EQ(offGrid[1].singular, 0u);
  // 0.99 to 1.01 at 512 points; another 300 move ratios of means by some percent, those of p99 by more
  for (const Metric metric :
       {Metric::kForm, Metric::kLightS, Metric::kLightM, Metric::kLightL, Metric::kBelow}) {
    EXPECT_LT(ratio(offGrid, metric, &Summary::mean), 1.03) << metricName(metric);
    EXPECT_LT(ratio(offGrid, metric, &Summary::p99), 1.1) << metricName(metric);
    EXPECT_LT(ratio(offGrid, metric, &Summary::max), 1.3) << metricName(metric);
  }
  // no kinks between nodes: 0.56
  const std::vector<Score> extreme = scoresOf(table, ChebyshevOptions().coefficients, PointSet::kExtreme);
  EXPECT_EQ(extreme[1].singular, 0u);
  EXPECT_LT(ratio(extreme, Metric::kForm, &Summary::mean), 0.7);
}

// So that the limits above mean something: half of the coefficients do not keep them.
TEST(ChebyshevScore, FewerCoefficientsShow) {
  const Table table = readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_iso.json");
  EXPECT_GT(ratio(scoresOf(table, 60, PointSet::kOffGrid), Metric::kForm, &Summary::mean), 1.1);
}

}  // namespace
}  // namespace ltcfit
