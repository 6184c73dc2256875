// How well-conditioned what a fitter minimises is, and whether its derivatives are right, at one matrix.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "fit/lobe_fit.h"

namespace ltcfit {

struct ObjectiveProbe {
  /// Ratio of the largest to the smallest of the absolute eigenvalues of the Hessian, over the parameters
  /// that the fit moves: P of M (I + P), in the family's basis.
  double conditionScaled = 0.0;
  /// The same over the raw entries of M, third column of length 1, without the directions that leave the
  /// lobe as it is (scale, rotation about z from the right).
  double conditionRaw = 0.0;
  /// Largest relative error of the derivatives that the fitter uses against central differences, near the
  /// matrix; nothing for a fitter without (l3).
  std::optional<double> gradientError;
};

/// Probes what `options.fitter` minimises about `m`, finite, det > 0, of the target's family. Hessians: light
/// Gauss-Newton's; sw and sw-sgd by differences of the gradient, l3 of the cost. Independent of threads.
ObjectiveProbe probeObjective(const LobeFitTarget& target, const Eigen::Matrix3d& m,
                              const LobeFitOptions& options);

/// The condition of `hessian`, over the parameters of `family` about `base`, in the raw entries of M =
/// base (I + sum of p_k B_k): a change E of the entries is P = base^-1 E.
double rawCondition(const Eigen::MatrixXd& hessian, MatrixFamily family, const Eigen::Matrix3d& base);

}  // namespace ltcfit
