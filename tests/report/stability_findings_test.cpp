#include "report/stability_findings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ltcfit {
namespace {

constexpr char kL3NoOverlap[] = "Nelder-Mead on L3 from a start that does not overlap the lobe";
constexpr char kSgdNoOverlap[] = "sw-sgd from a start that does not overlap the lobe";
constexpr char kL3Identity[] = "Nelder-Mead on L3 from the identity, sharp lobes (alpha <= 0.01)";
constexpr char kLightHessian[] = "light: the Hessian in raw entries of M";

// Two runs: from the usual start, and from `start` with `ratio` times its SW1.
StabilityRow row(Fitter fitter, Start start, double ratio, Outcome outcome = Outcome::kConverged) {
  StabilityRow r;
  r.fitter = fitter;
  r.parameters = {0.005, 0.005, 1.0, 0.0};
  r.sw1 = 0.02;
  r.runs.resize(2);
  r.runs[0].sw1 = r.sw1;
  r.runs[1].start = start;
  r.runs[1].sw1 = ratio * r.sw1;
  r.runs[1].outcome = outcome;
  return r;
}

StabilityRow probed(Fitter fitter, double raw, double scaled) {
  StabilityRow r = row(fitter, Start::kIdentity, 1.0);
  r.probe.conditionRaw = raw;
  r.probe.conditionScaled = scaled;
  return r;
}

StabilityFinding find(const std::vector<StabilityRow>& rows, const std::string& title) {
  for (StabilityFinding& f : stabilityFindings(rows))
    if (f.title == title) return f;
  ADD_FAILURE() << "no finding: " << title;
  return {};
}

bool says(const StabilityFinding& finding, const char* text) {
  return finding.text.find(text) != std::string::npos;
}

TEST(StabilityFindings, CountTheLobesThatAreNotReached) {
  std::vector<StabilityRow> rows{
      row(Fitter::kL3, Start::kNoOverlap, 40.0, Outcome::kFlat), row(Fitter::kL3, Start::kNoOverlap, 1.0),
      row(Fitter::kL3, Start::kNoOverlap, 3.1, Outcome::kOtherMinimum),
      row(Fitter::kL3, Start::kNoOverlap, 2.9), row(Fitter::kL3, Start::kNoOverlap, 9.0, Outcome::kFlat)};
  EXPECT_EQ(find(rows, kL3NoOverlap).rows, 3u);
  EXPECT_EQ(find(rows, kL3NoOverlap).of, 5u);
  EXPECT_TRUE(says(find(rows, kL3NoOverlap), "for 2 nothing")) << find(rows, kL3NoOverlap).text;
  // an SW1 that is no number is not reached
  rows[1].runs[1].sw1 = std::nan("");
  EXPECT_EQ(find(rows, kL3NoOverlap).rows, 4u);
  // one of several seeds is enough, and it counts once
  rows[3].runs.push_back(rows[0].runs[1]);
  rows[3].runs.push_back(rows[0].runs[1]);
  EXPECT_EQ(find(rows, kL3NoOverlap).rows, 5u);
  EXPECT_EQ(find(rows, kL3NoOverlap).of, 5u);
  EXPECT_TRUE(says(find(rows, kL3NoOverlap), "for 3 nothing")) << find(rows, kL3NoOverlap).text;
}

TEST(StabilityFindings, OneThatReachesAllHasNone) {
  const StabilityFinding none = find(
      {row(Fitter::kL3, Start::kNoOverlap, 1.0), row(Fitter::kL3, Start::kNoOverlap, 0.5, Outcome::kFlat)},
      kL3NoOverlap);
  EXPECT_EQ(none.rows, 0u);
  EXPECT_EQ(none.of, 2u);
  EXPECT_EQ(none.text.find("nothing at the start"), std::string::npos) << none.text;
}

TEST(StabilityFindings, OnlyOfTheStartAndTheLobesThatAreMeant) {
  // at normal view no start misses the lobe
  StabilityRow normal = row(Fitter::kL3, Start::kNoOverlap, 40.0);
  normal.parameters.theta = 0.0;
  // from the identity only the sharp ones count
  StabilityRow blunt = row(Fitter::kL3, Start::kIdentity, 40.0);
  blunt.parameters.alphaX = blunt.parameters.alphaY = 0.011;
  const std::vector<StabilityRow> rows{normal, blunt, row(Fitter::kL3, Start::kIdentity, 40.0),
                                       row(Fitter::kL3, Start::kNoOverlap, 40.0),
                                       row(Fitter::kL3, Start::kNeighbour, 40.0)};
  const StabilityFinding apart = find(rows, kL3NoOverlap);
  EXPECT_EQ(apart.rows, 1u);
  EXPECT_EQ(apart.of, 4u);  // all but the one of normal view
  const StabilityFinding identity = find(rows, kL3Identity);
  EXPECT_EQ(identity.rows, 1u);
  EXPECT_EQ(identity.of, 4u);  // all but the blunt one
}

TEST(StabilityFindings, EveryFitterIsCountedByItself) {
  const std::vector<StabilityRow> rows{row(Fitter::kL3, Start::kNoOverlap, 40.0, Outcome::kFlat),
                                       row(Fitter::kLight, Start::kNoOverlap, 40.0, Outcome::kFlat),
                                       row(Fitter::kSlicedWassersteinSgd, Start::kNoOverlap, 40.0),
                                       row(Fitter::kSlicedWassersteinSgd, Start::kNoOverlap, 1.0),
                                       row(Fitter::kSlicedWassersteinSgd, Start::kNoOverlap, 40.0)};
  const StabilityFinding sgd = find(rows, kSgdNoOverlap);
  EXPECT_EQ(sgd.rows, 2u);
  EXPECT_EQ(sgd.of, 3u);
  EXPECT_EQ(sgd.text.find("nothing at the start"), std::string::npos) << sgd.text;
  EXPECT_EQ(find(rows, kL3NoOverlap).rows, 1u);
  EXPECT_EQ(find(rows, kL3NoOverlap).of, 1u);
  // of fitters that did not run there is none
  const std::vector<StabilityFinding> alone = stabilityFindings({rows.back()});
  ASSERT_EQ(alone.size(), 1u);
  EXPECT_EQ(alone[0].title, kSgdNoOverlap);
  EXPECT_TRUE(stabilityFindings({}).empty());
}

TEST(StabilityFindings, CountDescentsThatNeededTheUsualStart) {
  std::vector<StabilityRow> rows{
      row(Fitter::kLight, Start::kIdentity, 1.0), row(Fitter::kLight, Start::kNoOverlap, 1.0),
      row(Fitter::kLight, Start::kNoOverlap, 1.0), row(Fitter::kL3, Start::kNoOverlap, 1.0)};
  const char* const title = "light: descents from other starts than the usual one, on their own";
  EXPECT_EQ(find(rows, title).rows, 0u);
  EXPECT_EQ(find(rows, title).of, 3u);
  for (const std::size_t i : {1u, 2u, 3u}) rows[i].runs[1].restarted = true;
  // a second seed of the same lobe counts once
  rows[1].runs.push_back(rows[1].runs[1]);
  EXPECT_EQ(find(rows, title).rows, 2u);
  EXPECT_TRUE(says(find(rows, title), "identity 0, neighbour 0, no-overlap 2")) << find(rows, title).text;
}

TEST(StabilityFindings, CountHessiansThatAreTenTimesWorse) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  StabilityRow blunt = probed(Fitter::kLight, 1e9, 1.0);
  blunt.parameters.alphaX = 0.011;
  const std::vector<StabilityRow> rows{probed(Fitter::kLight, 1e6, 100.0),
                                       probed(Fitter::kLight, 1100.0, 100.0),
                                       probed(Fitter::kLight, 900.0, 100.0),
                                       probed(Fitter::kLight, 100.0, 1e6),
                                       probed(Fitter::kLight, kInfinity, 100.0),  // no figure
                                       probed(Fitter::kLight, 1e6, std::nan("")),
                                       blunt,
                                       probed(Fitter::kSlicedWasserstein, 1e6, 100.0),
                                       probed(Fitter::kL3, 1e6, 100.0)};
  const StabilityFinding light = find(rows, kLightHessian);
  EXPECT_EQ(light.rows, 2u);
  EXPECT_EQ(light.of, 4u);
  // of four the upper one of the middle two
  EXPECT_TRUE(says(light, "medians 1.1e+03 and 1.0e+02")) << light.text;
  const StabilityFinding sw = find(rows, "sw: the Hessian in raw entries of M");
  EXPECT_EQ(sw.rows, 1u);
  EXPECT_EQ(sw.of, 1u);
  // none is worse
  EXPECT_EQ(find({probed(Fitter::kLight, 500.0, 100.0)}, kLightHessian).rows, 0u);
}

}  // namespace
}  // namespace ltcfit
