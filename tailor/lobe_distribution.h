// The parameters at which a scene looks a table up, as a distribution that points are drawn from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ltc/table.h"
#include "scene/scene_use.h"

namespace ltcfit {

/// What one table of a plan is for: some of the scene's lobes, seen from the scene's angles. Isotropic where
/// all lobes have alphaX = alphaY; then it is meant for an isotropic table.
struct LobeDistribution {
  bool isotropic = true;
  std::vector<LobeUse> lobes;  ///< not empty, weights > 0, distinct
  ViewUse views;
};

/// One look-up.
struct LookUp {
  LobeParameters parameters;  ///< alphaX >= alphaY, phi in [0, pi/2] (0 for an isotropic table)
  double f0 = 1.0;
  double f90 = 1.0;
};

/// `count` look-ups, all of the same weight: lobes as often as their weights say, alphas no smaller than
/// `alphaFloor`; views over the scene's range, uniform in sqrt(1 - cos theta) for isotropic tables, in theta
/// and phi for anisotropic ones (as the metrics' off-grid set has it). Quasi-random: another seed gives other
/// points, as evenly spread.
std::vector<LookUp> drawLookUps(const LobeDistribution& distribution, std::size_t count, double alphaFloor,
                                std::uint64_t seed);

}  // namespace ltcfit
