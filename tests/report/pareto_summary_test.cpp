#include "report/pareto_summary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ltcfit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ParetoRun run(double seconds, double error, bool converged = true) {
  ParetoRun r{.cpuSeconds = seconds, .converged = converged};
  r.errors.fill(error);
  return r;
}

// The front of settings of one fit each.
std::vector<bool> frontOf(const std::vector<std::pair<double, double>>& timesAndErrors) {
  std::vector<SettingRuns> runs;
  for (const auto& [seconds, error] : timesAndErrors) runs.push_back({{run(seconds, error)}});
  std::vector<bool> front;
  for (const SettingSummary& s : summarizePareto(runs)) front.push_back(s.errors[0].front);
  return front;
}

TEST(ParetoFront, KnownAnswer) {
  EXPECT_EQ(frontOf({{1, 5}, {2, 3}, {2, 4}, {3, 3}, {4, 1}, {4, 2}, {5, 1}, {0.5, 6}}),
            (std::vector<bool>{true, true, false, false, true, false, false, true}));
}

TEST(ParetoFront, EqualSettingsAreOnItTogether) {
  EXPECT_EQ(frontOf({{1, 2}, {1, 2}}), (std::vector<bool>{true, true}));
  EXPECT_EQ(frontOf({{1, 2}, {1, 2}, {1, 1.5}}), (std::vector<bool>{false, false, true}));
  EXPECT_EQ(frontOf({{1, 2}}), (std::vector<bool>{true}));
}

TEST(ParetoFront, WhatFailedIsNeverOnIt) {
  EXPECT_EQ(frontOf({{0.1, kInfinity}, {1, 1}}), (std::vector<bool>{false, true}));
  EXPECT_EQ(frontOf({{0.1, kInfinity}}), (std::vector<bool>{false}));
}

TEST(ParetoFront, SettingsOfFewerEntriesAreComparedThere) {
  // The ratio of C, 1.1 at the first entry, is below those of A (sqrt 3 over both) and B (sqrt 2). But where
  // C ran, A is better and faster.
  const std::vector<SettingSummary> s =
      summarizePareto({{{run(1, 1), run(1, 3)}}, {{run(2, 2), run(2, 1)}}, {{run(9, 1.1)}}});
  EXPECT_LT(s[2].errors[0].ratio.median, s[0].errors[0].ratio.median);
  EXPECT_LT(s[2].errors[0].ratio.median, s[1].errors[0].ratio.median);
  EXPECT_TRUE(beats(s[0], s[2], 0));
  EXPECT_FALSE(beats(s[1], s[2], 0));
  EXPECT_DOUBLE_EQ(errorOver(s[2], s[1], 0), 0.55);
  EXPECT_TRUE(s[0].errors[0].front);
  EXPECT_TRUE(s[1].errors[0].front);
  EXPECT_FALSE(s[2].errors[0].front);
}

TEST(ParetoSummary, SpreadOfRepeats) {
  const Spread odd = spreadOf({3.0, 1.0, 2.0});
  EXPECT_EQ(odd.median, 2.0);
  EXPECT_EQ(odd.low, 1.0);
  EXPECT_EQ(odd.high, 3.0);
  EXPECT_EQ(spreadOf({4.0, 1.0}).median, 2.5);
  EXPECT_EQ(spreadOf({7.0}).median, 7.0);
  EXPECT_EQ(spreadOf({1.0, kInfinity, kInfinity}).median, kInfinity);
  EXPECT_EQ(spreadOf({kInfinity, kInfinity}).median, kInfinity);
}

TEST(ParetoSummary, SummariesOfKnownRuns) {
  // A: three entries, three repeats; B: the first entry once, and best there
  const std::vector<SettingRuns> runs{{{run(1, 1), run(2, 2), run(6, 9)},
                                       {
                                           run(2, 2),
                                           run(2, 2),
                                           run(2, 8),
                                       },
                                       {run(9, 4), run(1, 4), run(2, 8, false)}},
                                      {{run(2, 0.5)}}};
  const std::vector<SettingSummary> s = summarizePareto(runs);
  EXPECT_EQ(s[0].entries, 3u);
  EXPECT_EQ(s[0].runs, 9u);
  EXPECT_EQ(s[0].notConverged, 1u);
  EXPECT_EQ(s[0].nonFinite, 0u);
  EXPECT_DOUBLE_EQ(s[0].cpuSeconds.median, 3.0);  // means over entries: 3, 2, 4
  EXPECT_DOUBLE_EQ(s[0].cpuSeconds.low, 2.0);
  EXPECT_DOUBLE_EQ(s[0].cpuSeconds.high, 4.0);
  // best: 0.5, 2, 8; ratios of A: 2 1 9/8; 4 1 1; 8 2 1
  const SettingErrors& a = s[0].errors[0];
  EXPECT_DOUBLE_EQ(a.ratio.low, std::cbrt(2.25));
  EXPECT_DOUBLE_EQ(a.ratio.median, std::cbrt(4.0));
  EXPECT_DOUBLE_EQ(a.ratio.high, std::cbrt(16.0));
  EXPECT_DOUBLE_EQ(a.value, std::cbrt(4.0 * 8.0));  // the geometric mean of 2, 2, 8
  EXPECT_FALSE(a.front);                            // B is cheaper and better
  // B at the entries it did not see: as the best of them
  EXPECT_EQ(s[1].entries, 1u);
  EXPECT_DOUBLE_EQ(s[1].errors[0].ratio.median, 1.0);
  EXPECT_DOUBLE_EQ(s[1].errors[0].value, 2.0);
  EXPECT_TRUE(s[1].errors[0].front);
}

TEST(ParetoSummary, AFailedFitIsNotHiddenByTheOthers) {
  const std::vector<SettingSummary> s =
      summarizePareto({{{run(1, 1), run(1, kInfinity, false)}}, {{run(2, 3), run(2, 3)}}});
  EXPECT_EQ(s[0].nonFinite, 1u);
  EXPECT_EQ(s[0].errors[0].ratio.median, kInfinity);
  EXPECT_FALSE(s[0].errors[0].front);
  EXPECT_DOUBLE_EQ(s[1].errors[0].ratio.median, std::sqrt(3.0));
  EXPECT_TRUE(s[1].errors[0].front);
}

}  // namespace
}  // namespace ltcfit
