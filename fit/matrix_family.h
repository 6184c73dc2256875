// The matrices among which an entry is sought, as small changes of the current one.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace ltcfit {

/// What the lobe's symmetry leaves free. A matrix of a family stays in it under M (I + P) with P from the
/// family's basis, so that symmetry holds by construction (KT et al. 2022, eq. 16).
enum class MatrixFamily {
  kGeneral,     ///< no symmetry: 7 parameters (9 less scale and rotation about z)
  kMirrorY,     ///< mirrored by the x-z plane (phi = 0): [a 0 b; 0 c 0; d 0 e], 4 parameters
  kMirrorX,     ///< mirrored by the y-z plane (phi = pi/2): [a 0 0; 0 b c; 0 d e], 4
  kMirrorXY,    ///< mirrored by both (theta = 0): diagonal, 2
  kRotational,  ///< turned about z (theta = 0, alpha_x = alpha_y): diag(a, a, b), 1
};

/// Basis of the changes P in M <- M (I + P): orthonormal in the Frobenius norm, without the identity (scale)
/// and without the rotation about z, which leave the lobe as it is. Relative to M the problem is equally
/// scaled for sharp and for rough lobes, where in raw entries its condition is 1 / alpha^2.
const std::vector<Eigen::Matrix3d>& familyBasis(MatrixFamily family);

/// The member of the family next to `m` in the Frobenius norm: the entries that must vanish set to 0, and for
/// kRotational m00 and m11 averaged. `m` should be aligned (ltc/alignment.h) before.
Eigen::Matrix3d projectOnFamily(const Eigen::Matrix3d& m, MatrixFamily family);

/// M (I + sum of p_k B_k).
Eigen::Matrix3d changedBy(const Eigen::Matrix3d& m, MatrixFamily family, std::span<const double> p);

}  // namespace ltcfit
