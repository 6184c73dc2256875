#include "report/pareto_ladder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "report/pareto_entries.h"

namespace ltcfit {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

// In 0..1, as paretoEntries spreads them.
std::array<double, 4> coordinatesOf(const LobeParameters& p) {
  return {(std::sqrt(p.alphaX) - 0.1) / 0.9, p.theta / kHalfPi, (std::sqrt(p.alphaY / p.alphaX) - 0.1) / 0.9,
          p.phi / kHalfPi};
}

TEST(ParetoEntries, CoverEveryRangeInEqualSteps) {
  for (const std::size_t n : {4u, 12u, 100u}) {
    const std::vector<LobeParameters> entries = paretoEntries(TableKind::kAnisotropic, n);
    ASSERT_EQ(entries.size(), n);
    for (std::size_t d = 0; d < 4; ++d) {
      std::vector<double> values;
      for (const LobeParameters& p : entries) values.push_back(coordinatesOf(p)[d]);
      std::sort(values.begin(), values.end());
      for (std::size_t i = 0; i < n; ++i)
        EXPECT_NEAR(values[i], static_cast<double>(i) / static_cast<double>(n - 1), 1e-12) << n << " " << d;
    }
    // the ends themselves: normal and grazing view, isotropic
    EXPECT_TRUE(std::any_of(entries.begin(), entries.end(), [](auto& p) { return p.theta == 0.0; }));
    EXPECT_TRUE(std::any_of(entries.begin(), entries.end(), [](auto& p) { return p.theta == kHalfPi; }));
    EXPECT_TRUE(std::any_of(entries.begin(), entries.end(), [](auto& p) { return p.alphaX == p.alphaY; }));
    EXPECT_TRUE(std::any_of(entries.begin(), entries.end(), [](auto& p) { return p.alphaX == 1.0; }));
  }
}

TEST(ParetoEntries, TheFirstOfThemAreSpreadToo) {
  const std::vector<LobeParameters> entries = paretoEntries(TableKind::kAnisotropic, 100);
  for (std::size_t d = 0; d < 4; ++d) {
    std::set<int> quarters;
    for (std::size_t i = 0; i < 12; ++i)
      quarters.insert(std::min(3, static_cast<int>(4.0 * coordinatesOf(entries[i])[d])));
    EXPECT_EQ(quarters.size(), 4u) << d;
  }
  // and all over the combinations of low and high
  std::set<int> corners;
  for (const LobeParameters& p : entries) {
    int corner = 0;
    for (const double c : coordinatesOf(p)) corner = 2 * corner + (c > 0.5 ? 1 : 0);
    corners.insert(corner);
  }
  EXPECT_EQ(corners.size(), 16u);
}

TEST(ParetoEntries, Isotropic) {
  double low = 1.0;
  double high = 0.0;
  for (const LobeParameters& p : paretoEntries(TableKind::kIsotropic, 12)) {
    EXPECT_EQ(p.alphaX, p.alphaY);
    EXPECT_EQ(p.phi, 0.0);
    low = std::min(low, p.alphaX);
    high = std::max(high, p.alphaX);
  }
  EXPECT_NEAR(low, 0.0025, 1e-15);
  EXPECT_EQ(high, 1.0);
  const LobeParameters one = paretoEntries(TableKind::kIsotropic, 1).at(0);
  EXPECT_DOUBLE_EQ(one.theta, 0.5 * kHalfPi);
  EXPECT_DOUBLE_EQ(std::sqrt(one.alphaX), 0.525);
}

TEST(ParetoLadder, TheDefaultIsWhatTablesAreFittedWith) {
  for (const TableKind kind : {TableKind::kIsotropic, TableKind::kAnisotropic}) {
    const std::vector<FitSetting> ladder = paretoLadder(kind);
    const LobeFitOptions expected = tableFitPreset(kind, kDefaultFitter);
    std::size_t defaults = 0;
    for (const FitSetting& s : ladder) {
      if (!s.isDefault) continue;
      ++defaults;
      EXPECT_EQ(s.fitter, fitterName(kDefaultFitter));
      EXPECT_EQ(s.preset, defaultPreset(kind, kDefaultFitter));
      EXPECT_EQ(s.options.fitter, kDefaultFitter);
      EXPECT_EQ(s.options.light.lights.lights, expected.light.lights.lights);
      EXPECT_EQ(s.options.light.lights.sizeExponent, expected.light.lights.sizeExponent);
      EXPECT_EQ(s.options.light.lights.weighting, expected.light.lights.weighting);
      EXPECT_EQ(s.options.light.leakWeight, expected.light.leakWeight);
      EXPECT_EQ(s.options.light.maxIterations, expected.light.maxIterations);
      EXPECT_EQ(s.options.light.relativeCostTolerance, expected.light.relativeCostTolerance);
    }
    EXPECT_EQ(defaults, 1u);
  }
}

TEST(ParetoLadder, HoldsAllPresetsAndEachSettingOnce) {
  for (const TableKind kind : {TableKind::kIsotropic, TableKind::kAnisotropic}) {
    std::set<std::string> names;
    std::set<std::string> presets;
    std::string error;
    for (const FitSetting& s : paretoLadder(kind)) {
      EXPECT_TRUE(names.insert(s.fitter + s.name).second) << s.name;
      if (!s.preset.empty()) presets.insert(s.fitter + " " + s.preset);
      EXPECT_TRUE(s.options.isValid(&error)) << s.name << ": " << error;
    }
    EXPECT_EQ(presets, (std::set<std::string>{"light fast", "light standard", "light fine", "sw fast",
                                              "sw standard", "sw fine", "sw-sgd quick", "sw-sgd paper"}));
  }
}

TEST(ParetoLadder, CostlySettingsRunOnFewerEntries) {
  for (const FitSetting& s : paretoLadder(TableKind::kAnisotropic)) {
    const FitShare twelve = shareOf(s, 12, 3);
    const FitShare one = shareOf(s, 1, 3);
    const FitShare many = shareOf(s, 1000, 10);
    if (s.preset == "paper") {
      EXPECT_EQ(twelve.entries, 2u);
      EXPECT_EQ(twelve.repeats, 1u);
      EXPECT_EQ(one.entries, 1u);
      EXPECT_EQ(one.repeats, 2u);
      EXPECT_EQ(many.entries, 2u);
      EXPECT_EQ(many.repeats, 1u);
    } else if (s.name == "3000 steps, 2048 x 64") {
      EXPECT_EQ(twelve.entries, 6u);  // 0.3 of the paper's steps: 6 of them take less than two of its fits
      EXPECT_EQ(twelve.repeats, 1u);
    } else if (s.name == "3000 steps, 1024 x 32") {
      EXPECT_EQ(twelve.entries, 12u);  // 26 fits
      EXPECT_EQ(twelve.repeats, 2u);
    } else {
      EXPECT_EQ(twelve.entries, 12u) << s.name;
      EXPECT_EQ(twelve.repeats, 3u) << s.name;
    }
    EXPECT_GE(many.entries, 2u) << s.name;
  }
}

}  // namespace
}  // namespace ltcfit
