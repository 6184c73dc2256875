// Weighted directions of a lobe: what the sliced-Wasserstein fits see of it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ggx/lobe.h"
#include "ggx/random.h"

namespace ltcfit {

/// Directions of a lobe with weights > 0 that sum to 1.
struct LobeSamples {
  std::vector<Eigen::Vector3d> directions;
  std::vector<double> weights;

  Eigen::Vector3d mean() const;
};

/// The lobe's own samples at `count` quasi-random points (R2, so that a prefix is evenly spread too),
/// weighted by eval / pdf. Nothing is rejected, so that the points keep their spread; those of weight 0
/// (below the horizon) are left out. More samples of less weight go to the tails: see kTailExponent.
LobeSamples weightedSamples(const Lobe& lobe, int count, std::uint64_t seed);

/// `count` independent directions of density eval / albedo, all of weight 1 / count, by rejection (KT et al.
/// 2022, Algorithm 1, with the corrected weight: GgxLobe::acceptance). The weight of the lobe's samples must
/// lie in [0, 1], as GGX's does.
std::vector<Eigen::Vector3d> rejectionSamples(const Lobe& lobe, int count, Random& random);

/// `count` directions of the clamped cosine, with weights that sum to 1, on a Fibonacci lattice. More of less
/// weight lie near the horizon, whence the LTC takes the tails of its lobe: see kTailExponent. `seed` turns
/// the lattice about the normal.
LobeSamples cosineSamples(int count, std::uint64_t seed);

/// z = v^kTailExponent for v uniform, where the cosine itself has 1/2: the outermost of 2048 samples then
/// lies at a slope of 140 instead of 45. Lobes at grazing view have tails that reach that far, and a fit that
/// cannot see them makes up its own. Of 0.5, 0.65, 0.75, 0.9, 1 (8^4 table, 2048 samples): mean SW1 on unseen
/// samples 0.9939, 0.9924, 0.9924, 0.9925, 0.9927 of the published table's.
inline constexpr double kTailExponent = 0.65;

}  // namespace ltcfit
