#include "fit/fit_provenance.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ltcfit {
namespace {

TableInfo infoOf(TableKind kind, Provenance provenance) {
  TableInfo info = kind == TableKind::kIsotropic
                       ? planIsotropicTable(IsotropicTableOptions{}).info
                       : planAnisotropicTable(AnisotropicTableOptions{.alphaNodes = 3, .lambdaNodes = 2},
                                              SymmetryMode::kDuring)
                             .info;
  info.provenance = std::move(provenance);
  return info;
}

FitRecipe recipeOf(TableKind kind, Fitter fitter, const std::string& preset = {}) {
  return {kind, preset, tableFitPreset(kind, fitter, preset), SymmetryMode::kDuring};
}

RecordedFit readBack(const FitRecipe& recipe, std::int64_t seed) {
  return fitFromProvenance(infoOf(recipe.kind, {"ltcfit", "", "", seed, provenanceOptions(recipe)}));
}

TEST(FitProvenance, KeepsEveryOptionOfEveryFitter) {
  for (const TableKind kind : {TableKind::kIsotropic, TableKind::kAnisotropic}) {
    const bool isotropic = kind == TableKind::kIsotropic;
    FitRecipe light = recipeOf(kind, Fitter::kLight, "fine");
    light.fit.light.lights.lights = 77;
    light.fit.light.lights.weighting = LightWeighting::kMixed;
    light.fit.light.lights.sizeExponent = -0.3;
    light.fit.light.leakWeight = 0.7;
    const LobeFitOptions a = readBack(light, 3).recipe.fit;
    EXPECT_EQ(a.fitter, Fitter::kLight);
    EXPECT_EQ(a.light.lights.lights, 77);
    EXPECT_EQ(a.light.lights.weighting, LightWeighting::kMixed);
    EXPECT_EQ(a.light.lights.sizeExponent, -0.3);
    EXPECT_EQ(a.light.leakWeight, 0.7);
    EXPECT_EQ(a.light.lights.seed, 3u);

    FitRecipe sw = recipeOf(kind, Fitter::kSlicedWasserstein, "fine");
    sw.fit.sw.levels.back().samples = 64;
    sw.fit.sw.levels.back().slices = 8;
    sw.fit.sw.leakWeight = 0.1;
    sw.symmetry = isotropic ? SymmetryMode::kDuring : SymmetryMode::kAfter;
    const FitRecipe b = readBack(sw, 3).recipe;
    EXPECT_EQ(b.fit.fitter, Fitter::kSlicedWasserstein);
    EXPECT_EQ(b.fit.sw.levels.back().samples, 64);
    EXPECT_EQ(b.fit.sw.levels.back().slices, 8);
    EXPECT_EQ(b.fit.sw.levels.back().targetSamples,
              slicedWassersteinPreset("fine").levels.back().targetSamples);
    EXPECT_EQ(b.fit.sw.leakWeight, 0.1);
    EXPECT_EQ(b.fit.sw.seed, 3u);
    EXPECT_EQ(b.symmetry, sw.symmetry);

    FitRecipe sgd = recipeOf(kind, Fitter::kSlicedWassersteinSgd, "paper");
    sgd.fit.sgd.samples = 33;
    sgd.fit.sgd.slices = 5;
    const LobeFitOptions c = readBack(sgd, 3).recipe.fit;
    EXPECT_EQ(c.sgd.steps, paperSgdOptions().steps);
    EXPECT_EQ(c.sgd.samples, 33);
    EXPECT_EQ(c.sgd.slices, 5);
    EXPECT_EQ(c.sgd.seed, 3u);

    FitRecipe l3 = recipeOf(kind, Fitter::kL3);
    l3.fit.l3.samples = 100;
    l3.fit.l3.nelderMead.maxEvaluations = 30;
    if (isotropic) l3.fit.l3.family = IsotropicFamily::kMeanFrame3;
    const LobeFitOptions d = readBack(l3, 3).recipe.fit;
    EXPECT_EQ(d.fitter, Fitter::kL3);
    EXPECT_EQ(d.l3.samples, 100);
    EXPECT_EQ(d.l3.nelderMead.maxEvaluations, 30);
    EXPECT_EQ(d.l3.family, l3.fit.l3.family);
    EXPECT_EQ(d.l3.seed, 3u);

    for (const FitRecipe* const r : {&light, &sw, &sgd, &l3}) {
      const RecordedFit back = readBack(*r, 3);
      EXPECT_EQ(provenanceOptions(back.recipe), provenanceOptions(*r));
      EXPECT_TRUE(back.hasFitter);
      EXPECT_TRUE(back.notes.empty());
    }
  }
}

TEST(FitProvenance, WhatNoFitHasIsLeftAndNoted) {
  const auto read = [](std::vector<std::pair<std::string, Provenance::Value>> options,
                       std::int64_t seed = 1) {
    return fitFromProvenance(infoOf(TableKind::kIsotropic, {"ltcfit", "", "", seed, std::move(options)}));
  };
  const LobeFitOptions usual = tableFitPreset(TableKind::kIsotropic, Fitter::kSlicedWasserstein);
  const RecordedFit sw = read({{"fitter", std::string("sw")},
                               {"preset", std::string("slow")},
                               {"samples", std::int64_t{1'000'000'000'000}},
                               {"directions", 8.5},
                               {"leak_weight", std::nan("")}},
                              -4);
  EXPECT_EQ(sw.recipe.fit.sw.levels.back().samples, usual.sw.levels.back().samples);
  EXPECT_EQ(sw.recipe.fit.sw.levels.back().slices, usual.sw.levels.back().slices);
  EXPECT_EQ(sw.recipe.fit.sw.leakWeight, usual.sw.leakWeight);
  EXPECT_EQ(sw.recipe.fit.sw.seed, 1u);
  ASSERT_EQ(sw.notes.size(), 5u);
  EXPECT_EQ(sw.notes[0], "provenance.options.preset: no fit has 'slow'; the default is taken");
  EXPECT_EQ(sw.notes[1], "provenance.options.samples: no fit has 1000000000000; the default is taken");
  EXPECT_EQ(sw.notes[4], "provenance.seed: no fit has -4; 1 is taken");

  const RecordedFit none = read({{"fitter", std::int64_t{4}}, {"family", true}});
  EXPECT_FALSE(none.hasFitter);
  EXPECT_EQ(none.notes.size(), 2u);
  std::string error;
  EXPECT_TRUE(none.recipe.fit.isValid(&error)) << error;
}

TEST(FitProvenance, TablesWithoutAFitterAreThoseOfThePapers) {
  const RecordedFit y2017 = fitFromProvenance(
      infoOf(TableKind::kIsotropic, {"a table", "", "", 0, {{"family", std::string("3")}}}));
  EXPECT_EQ(y2017.recipe.fit.fitter, Fitter::kL3);
  EXPECT_EQ(y2017.recipe.fit.l3.family, IsotropicFamily::kMeanFrame3);
  const RecordedFit y2022 = fitFromProvenance(infoOf(TableKind::kAnisotropic, {}));
  EXPECT_EQ(y2022.recipe.fit.fitter, Fitter::kSlicedWasserstein);
  EXPECT_EQ(y2022.recipe.fit.sw.leakWeight, 0.0);
  EXPECT_FALSE(y2022.hasFitter);
}

TEST(FitProvenance, ARefinedTableKeepsTheSeedOfItsFit) {
  Provenance p{"ltcfit", "", "", 9, provenanceOptions(recipeOf(TableKind::kIsotropic, Fitter::kLight))};
  p.options.emplace_back("fit_seed", std::int64_t{5});
  EXPECT_EQ(fitFromProvenance(infoOf(TableKind::kIsotropic, p)).recipe.fit.light.lights.seed, 5u);
}

}  // namespace
}  // namespace ltcfit
