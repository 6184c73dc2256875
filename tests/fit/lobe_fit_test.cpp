#include "fit/lobe_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>
#include <stdexcept>

namespace ltcfit {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

TEST(LobeFit, NamesAndPresets) {
  for (const Fitter f :
       {Fitter::kSlicedWasserstein, Fitter::kSlicedWassersteinSgd, Fitter::kL3, Fitter::kLight}) {
    EXPECT_EQ(fitterFromName(fitterName(f)), f);
    std::string error;
    EXPECT_TRUE(tableFitPreset(TableKind::kIsotropic, f).isValid(&error)) << error;
    EXPECT_EQ(tableFitPreset(TableKind::kAnisotropic, f).fitter, f);
    EXPECT_THROW(tableFitPreset(TableKind::kIsotropic, f, "slow"), std::invalid_argument);
  }
  EXPECT_THROW(fitterFromName("newton"), std::invalid_argument);
  EXPECT_EQ(tableFitPreset(TableKind::kIsotropic, Fitter::kLight).light.lights.lights,
            lightFitPreset("fast").lights.lights);
  EXPECT_EQ(tableFitPreset(TableKind::kAnisotropic, Fitter::kLight).light.lights.lights,
            lightFitPreset("standard").lights.lights);
}

TEST(LobeFit, LightsThatDoNotHoldTheLobeHandItOver) {
  const LobeFitOptions options = tableFitPreset(TableKind::kAnisotropic, Fitter::kLight);
  const auto fitOf = [&](const LobeParameters& p) {
    LobeFitTarget target({p, familyOf(p)}, "ggx", options);
    LobeFit fit = fitLobe(target, target.momentStart(), options);
    // never worse than what tables accept
    EXPECT_LT(target.judge()(fit.m, nullptr), 1.5 * target.judge()(target.momentStart(), nullptr));
    if (fit.startKept) {
      EXPECT_EQ(fit.m, target.momentStart());
    }
    return fit;
  };
  EXPECT_FALSE(fitOf({0.5, 0.2, 0.9, 0.4}).handedOver);
  // a needle of 100:1 that is nearly all tail: no light sees its width
  const LobeFit needle = fitOf({1e-3, 1e-5, 89.99 / 180.0 * std::numbers::pi, kHalfPi});
  EXPECT_TRUE(needle.handedOver);
  EXPECT_GT(needle.m.determinant(), 0.0);
}

}  // namespace
}  // namespace ltcfit
