#include "report/direct_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "export/json_table.h"
#include "fit/table_fit.h"
#include "report/score.h"

namespace ltcfit {
namespace {

FitRecipe recipeOf(TableKind kind, Fitter fitter) {
  FitRecipe r{kind, {}, tableFitPreset(kind, fitter), SymmetryMode::kDuring};
  r.fit.setSeed(7);
  LobeFitOptions& o = r.fit;
  switch (fitter) {
    case Fitter::kLight:
      o.light.lights.lights = 40;
      o.light.lights.weighting = LightWeighting::kMixed;
      o.light.lights.sizeExponent = -0.7;
      o.light.leakWeight = 0.3;
      break;
    case Fitter::kSlicedWasserstein:
      o.sw.levels.back().samples = 64;
      o.sw.levels.back().slices = 8;
      o.sw.leakWeight = 0.4;
      break;
    case Fitter::kSlicedWassersteinSgd:
      o.sgd.samples = 16;
      o.sgd.slices = 4;
      break;
    case Fitter::kL3:
      o.l3.samples = 32;
      o.l3.nelderMead.maxEvaluations = 15;
      break;
  }
  return r;
}

// A small table by the recipe, written and read.
Table fitted(const FitRecipe& r) {
  const TableFitOptions options{r.fit, 2};
  TableInfo info;
  std::vector<float> data;
  if (r.kind == TableKind::kIsotropic) {
    IsotropicTableOptions size;
    size.thetaNodes = size.alphaNodes = 4;
    size.alphaFloor = 0.02;
    if (r.fit.fitter == Fitter::kL3) {
      IsotropicFitResult result = fitIsotropicTable({size, r.fit.l3, 2});
      info = result.info;
      data = result.data;
    } else {
      const TablePlan plan = planIsotropicTable(size);
      info = plan.info;
      data = fitTable(plan, r.symmetry, options, nullptr).data;
    }
  } else {
    AnisotropicTableOptions size;
    size.alphaNodes = size.thetaNodes = 3;
    size.lambdaNodes = size.phiNodes = 2;
    size.alphaFloor = 0.05;
    const TablePlan plan = planAnisotropicTable(size, r.symmetry);
    info = plan.info;
    data = fitTable(plan, r.symmetry, options, nullptr).data;
  }
  info.provenance = {"ltcfit", "", "", 7, provenanceOptions(r)};
  return tableFromJson(tableToJson(Table(std::move(info), std::move(data))), "table");
}

ScoreOptions quickScore() {
  ScoreOptions o;
  o.count = 0;
  o.interpolation = true;
  o.metrics.samples = 64;
  o.metrics.directions = 8;
  o.metrics.quads = o.metrics.lights = 1;
  return o;
}

// Rounding to float32 is part of a direct fit: what is left is the double arithmetic of the inverses.
constexpr double kSame = 1e-9;

void expectRatioOne(const FitRecipe& r, const char* what) {
  const Table table = fitted(r);
  const Score s = scoreTables({&table}, quickScore())[0];
  EXPECT_TRUE(s.notes.empty()) << what;
  for (const PointScore& p : s.all) {
    EXPECT_NEAR(p.metrics.get(Metric::kInterpolationRatio), 1.0, kSame)
        << what << ": alpha " << p.parameters.alphaX << ", " << p.parameters.alphaY << ", theta "
        << p.parameters.theta << ", phi " << p.parameters.phi;
  }
}

TEST(DirectFit, TheRatioAtNodesIsOneByDefinition) {
  for (const TableKind kind : {TableKind::kIsotropic, TableKind::kAnisotropic}) {
    for (const Fitter fitter :
         {Fitter::kLight, Fitter::kSlicedWasserstein, Fitter::kSlicedWassersteinSgd, Fitter::kL3}) {
      expectRatioOne(recipeOf(kind, fitter), std::string(fitterName(fitter)).c_str());
    }
  }
}

TEST(DirectFit, TheRatioAtNodesIsOneForSymmetryAfter) {
  for (const Fitter fitter : {Fitter::kSlicedWasserstein, Fitter::kL3}) {
    FitRecipe r = recipeOf(TableKind::kAnisotropic, fitter);
    r.symmetry = SymmetryMode::kAfter;
    expectRatioOne(r, std::string(fitterName(fitter)).c_str());
  }
}

TEST(DirectFit, TheRatioAtNodesIsOneForFamilyThree) {
  FitRecipe r = recipeOf(TableKind::kIsotropic, Fitter::kL3);
  r.fit.l3.family = IsotropicFamily::kMeanFrame3;
  expectRatioOne(r, "l3, family 3");
}

TEST(DirectFit, BetweenNodesATableOfFewPaysForInterpolation) {
  FitRecipe r = recipeOf(TableKind::kIsotropic, Fitter::kL3);
  r.fit.l3.samples = 256;
  r.fit.l3.nelderMead.maxEvaluations = 1000;
  const Table table = fitted(r);
  ScoreOptions o = quickScore();
  o.set = PointSet::kOffGrid;
  o.count = 12;
  o.metrics.samples = 1024;
  const Score s = scoreTables({&table}, o)[0];
  EXPECT_GT(s.summary[static_cast<std::size_t>(Metric::kInterpolationRatio)].p50, 1.2);
  EXPECT_EQ(s.summary[static_cast<std::size_t>(Metric::kInterpolationRatio)].nonFinite, 0u);
}

TEST(DirectFit, EffortsThatTakeTooLongAreReplacedAndNoted) {
  const Table sw = fitted(recipeOf(TableKind::kIsotropic, Fitter::kSlicedWasserstein));
  const auto scored = [&](std::vector<std::pair<std::string, Provenance::Value>> options) {
    TableInfo info = sw.info();
    info.provenance.options = std::move(options);
    const Table table(info, sw.data());
    ScoreOptions o = quickScore();
    o.count = 2;
    return scoreTables({&table}, o)[0];
  };
  const Score paper = scored({{"fitter", std::string("sw-sgd")}, {"preset", std::string("paper")}});
  ASSERT_EQ(paper.notes.size(), 1u);
  EXPECT_TRUE(paper.notes[0].starts_with("direct fits are by sw with its usual effort")) << paper.notes[0];
  EXPECT_TRUE(scored({{"fitter", std::string("sw-sgd")}, {"preset", std::string("quick")}}).notes.empty());
  // allowed numbers, which together take days
  const Score days = scored({{"fitter", std::string("l3")},
                             {"samples", std::int64_t{1} << 22},
                             {"max_evaluations", std::int64_t{1'000'000}}});
  EXPECT_EQ(days.notes.size(), 1u);
  EXPECT_TRUE(std::isfinite(days.all[0].metrics.get(Metric::kInterpolationRatio)));
  for (const char* const fitter : {"light", "sw"}) {
    EXPECT_EQ(scored({{"fitter", std::string(fitter)}, {"preset", std::string("fine")}}).notes.size(), 0u);
  }
}

}  // namespace
}  // namespace ltcfit
