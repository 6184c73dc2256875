// Alignment: which of the matrices of one lobe a table stores, so that neighbours interpolate.
#pragma once

#include <Eigen/Core>

namespace ltcfit {

struct Alignment {
  /// M Q, the same lobe as M, with det M Q of the sign of det M: Q is a rotation about z.
  Eigen::Matrix3d m;
  /// Angle of Q, radians, (-pi, pi].
  double angle = 0.0;
  /// How well the angle is determined, for sharp lobes as for rough ones: the amplitude of eq. 12 over the
  /// angle against the largest that the entries of C allow. 1 where both axes pull alike, 0.71 where only one
  /// does, 0 where they pull against each other and all angles are equally good.
  double strength = 0.0;
  /// Mean squared distance between the cosine samples and where they are taken (eq. 12), before and after.
  double distanceBefore = 0.0;
  double distanceAfter = 0.0;
  /// The best of all rotations and flips would have det M Q < 0. Flips are left out so that det M stays
  /// positive; where this is true near a seam, look at the neighbours.
  bool flipWouldBeCloser = false;
};

/// Minimises E |N(M Q x) - x|^2 over the rotations Q about z, x from the clamped cosine, N the normalisation
/// (KT et al. 2022, eq. 12). In closed form: the expectation is const - 2 tr(Q^T C), C the upper left 2x2
/// block of E[x N(M x)^T] (math in the .cpp), so that Q turns by atan2(C10 - C01, C00 + C11); no search over
/// angles. C by a fixed quadrature that is symmetric in x and y.
Alignment align(const Eigen::Matrix3d& m);

}  // namespace ltcfit
