// A matrix rounded to half precision so that its lobe stays.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "ltc/table.h"

namespace ltcfit {

/// Relative error of the determinant that a rounding may leave. The goal is 1 %; the rest is left to the
/// float32 arithmetic of whoever measures it on a matrix with cancelling terms.
inline constexpr double kHalfDeterminantLimit = 0.0095;

struct HalfRounding {
  Eigen::Matrix3d matrix;  ///< the free entries are halves, none on the diagonal zero or subnormal
  double shift = 0.0;      ///< mean distance between directions of the two lobes, radians
  double between = 0.0;    ///< the largest such distance at the node and, where those were looked at, near it
  double detError = 0.0;   ///< |det(matrix) / det(given) - 1|; above the limit where halves cannot meet it
  bool moved = false;      ///< some entry is not the half nearest to it
  bool constrained = false;  ///< the nearest halves would have broken a bound below
};

/// Rounds the entries marked in `free` (row-major) to halves; the others stay as they are. `stored` is M or
/// its inverse, as `stores` says, with det != 0. `neighbours` are the matrices of the nodes next to it.
///
/// What is minimised is not the rounding of each number but the shift of the lobe: the mean distance on the
/// unit sphere between M x / |M x| and M' x / |M' x| over directions x of the cosine, an upper bound of the
/// transport distance between the two lobes. Bounds:
///   entries keep their sign (or become zero off the diagonal), zeros stay zero: between nodes nothing
///   changes sides that did not before; those on the diagonal are normal halves: zero makes matrices
///   singular, subnormals have few digits; the determinant keeps within kHalfDeterminantLimit where halves
///   near the matrix can do so.
/// Where the diagonal has to be lifted out of the subnormal halves (90 degrees at the smallest alphas), the
/// shift halfway to the neighbours counts as much as the node's own, and the determinant comes second to
/// both. Throws Refusal for entries that no half reaches.
HalfRounding roundToHalf(const Eigen::Matrix3d& stored, MatrixStorage stores, const std::array<bool, 9>& free,
                         std::span<const Eigen::Matrix3d> neighbours = {});

}  // namespace ltcfit
