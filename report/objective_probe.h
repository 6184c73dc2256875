// How well-conditioned what a fitter minimises is, and whether its derivatives are right, at one matrix.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>

#include "fit/lobe_fit.h"

namespace ltcfit {

struct ObjectiveProbe {
  /// Ratio of the largest to the smallest of the absolute eigenvalues of the Hessian, over the parameters
  /// that the fit moves: P of M (I + P), in the family's basis.
  double conditionScaled = 0.0;
  /// The same over the raw entries of M, third column of length 1, without the directions that leave the
  /// lobe as it is (scale, rotation about z from the right).
  double conditionRaw = 0.0;
  /// Relative error (norm) of the gradient, for light of the Jacobian, that the fitter uses against central
  /// differences, near the matrix; the smallest over some steps. Nothing for a fitter without (l3).
  std::optional<double> gradientError;
};

/// Probes what `options.fitter` minimises about `m`, finite, det > 0, of the target's family. Hessians: light
/// Gauss-Newton's; sw and sw-sgd by differences of the gradient, l3 of the cost. Independent of threads.
ObjectiveProbe probeObjective(const LobeFitTarget& target, const Eigen::Matrix3d& m,
                              const LobeFitOptions& options);

/// A cost and, unless null, its gradient.
using GradientFunction = std::function<double(const Eigen::VectorXd&, Eigen::VectorXd*)>;

/// Relative error (norm) of the gradient at a point against central differences: the smallest over the steps,
/// as a wrong derivative is wrong at every step and a right one only where digits are left.
double gradientErrorOf(const GradientFunction& cost, const Eigen::VectorXd& at,
                       std::span<const double> steps);

/// Of the n largest absolute eigenvalues of a symmetric matrix, the first over the last: the other ones
/// belong to directions that change nothing. Infinite where the last is 0.
double conditionOf(const Eigen::MatrixXd& hessian, Eigen::Index n);

/// Of M: its largest over its smallest singular value.
double conditionOf(const Eigen::Matrix3d& m);

/// The condition of `hessian`, over the parameters of `family` about `base`, in the raw entries of M =
/// base (I + sum of p_k B_k): a change E of the entries is P = base^-1 E.
double rawCondition(const Eigen::MatrixXd& hessian, MatrixFamily family, const Eigen::Matrix3d& base);

}  // namespace ltcfit
