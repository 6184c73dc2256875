// Stochastic descent on the sliced-Wasserstein loss: the fit of KT et al. 2022.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "ggx/lobe.h"

namespace ltcfit {

/// Algorithm 3 of KT et al. 2022: every step draws new samples of the lobe (by rejection) and of the LTC, and
/// new random slices, and moves M by -epsilon times the gradient, in raw entries.
///
/// The paper does not say what epsilon is. Here it falls geometrically from `firstStep` to `lastStep` times
/// the sine of the lobe's spread: an L1 loss has a gradient of order 1 wherever M is wrong, so that the
/// steps, not the gradient, must shrink, and to below the width of the lobe. After each step M is divided by
/// the length of its third column, which the loss does not see, so that epsilon keeps its meaning.
struct SgdOptions {
  int steps = 1000;
  int samples = 1024;  ///< of the lobe, and as many of the LTC, in each step
  int slices = 32;     ///< random directions in each step
  double firstStep = 0.5;
  /// 0.01, 0.003, 0.001, 0.0003 end at 1.047, 1.031, 1.027, 1.023 of the fast solver's SW1 at alpha 0.57 x
  /// 0.33, theta 51 and after 1500 steps; the first one makes no difference from 0.1 to 0.5.
  double lastStep = 0.001;
  std::uint64_t seed = 1;

  /// False with the reason in `error` for values that make no sense.
  bool isValid(std::string* error) const;
};

/// 10,000 steps of 2048 samples and 64 slices: section 4.2 of the paper.
SgdOptions paperSgdOptions();

struct SgdResult {
  Eigen::Matrix3d m;       ///< third column of length 1
  double startLoss = 0.0;  ///< mean of the first and of the last hundredth of the steps, each on its own
  double loss = 0.0;       ///< samples: both hold the noise of the samples
  bool finite = false;     ///< M stayed finite
};

/// Descends from `start` (det != 0). The lobe's sample weights must lie in [0, 1].
SgdResult descendSlicedWasserstein(const Lobe& lobe, const Eigen::Matrix3d& start, const SgdOptions& options);

}  // namespace ltcfit
