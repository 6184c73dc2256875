// The fast solver for the sliced-Wasserstein loss: one matrix, deterministic samples, quasi-Newton.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fit/bfgs.h"
#include "fit/matrix_family.h"
#include "fit/projected_cdf_loss.h"

namespace ltcfit {

/// One stage of the descent; a cheap one first brings the matrix near.
struct SlicedWassersteinLevel {
  int samples = 2048;        ///< directions of the cosine; 8 times as many for lobes narrower than 0.01
  int slices = 64;           ///< on the half sphere; symmetric families need, and get, fewer
  int targetSamples = 8192;  ///< directions of the lobe
};

struct SlicedWassersteinFitOptions {
  std::vector<SlicedWassersteinLevel> levels{{512, 24, 2048}, {2048, 96, 8192}};
  BfgsOptions bfgs{.maxIterations = 40, .relativeCostTolerance = 1e-5};
  std::uint64_t seed = 1;
  /// Added to the loss: leakWeight * (width of the lobe, at most 1) * (mass below the horizon). Light from
  /// below the horizon is the fault that users report; this trades SW1 for less of it.
  double leakWeight = 0.0;

  /// False with a message naming the option, its value and its range.
  bool isValid(std::string* error) const;
};

/// Levels by name: "fast" (the default of isotropic tables), "standard" (of anisotropic ones) and "fine",
/// which takes some ten times as long for the last half percent. Throws Refusal for another
/// name.
SlicedWassersteinFitOptions slicedWassersteinPreset(std::string_view name);

struct SlicedWassersteinFit {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();  ///< det > 0; in the family, any scale
  double startLoss = 0.0;                           ///< of the start, by the samples of the last level
  double loss = 0.0;                                ///< at the end, by the same
  int evaluations = 0;                              ///< of all levels
  Termination termination = Termination::kFailure;  ///< of the last level
  bool restarted = false;                           ///< the start's own descent did not arrive
};

/// What a fit knows of its lobe.
struct SlicedWassersteinTarget {
  LobeSamples samples;    ///< as many as the level that needs most
  Eigen::Matrix3d start;  ///< momentStart() of them, in the family
  MatrixFamily family;    ///< symmetry of the lobe
};
SlicedWassersteinTarget makeTarget(const Lobe& lobe, MatrixFamily family,
                                   const SlicedWassersteinFitOptions& options);

/// The loss of one level. That of the last one also judges matrices that were found otherwise.
ProjectedCdfLoss makeLoss(const SlicedWassersteinTarget& target, const SlicedWassersteinLevel& level,
                          std::uint64_t seed);

/// Minimises the loss over the matrices of the target's family from `start`: target.start, or any other
/// matrix of the family with det != 0. After each descent the parametrisation M (I + P) is taken anew about
/// the matrix found, until that gains nothing, so that a start of another scale costs only time. From another
/// start than target.start the first level descends from both, and keeps the minimum of target.start unless
/// the other's is lower by a tenth. `finest` is makeLoss of the last level.
SlicedWassersteinFit fitSlicedWasserstein(const SlicedWassersteinTarget& target, const Eigen::Matrix3d& start,
                                          const SlicedWassersteinFitOptions& options,
                                          ProjectedCdfLoss& finest);

}  // namespace ltcfit
