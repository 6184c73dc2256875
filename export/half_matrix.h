// A matrix rounded to half precision so that its lobe stays.
#pragma once

#include <Eigen/Core>
#include <array>

#include "ltc/table.h"

namespace ltcfit {

/// Relative error of the determinant that a rounding may leave. The goal is 1 %; the rest is left to the
/// float32 arithmetic of whoever measures it on a matrix with cancelling terms.
inline constexpr double kHalfDeterminantLimit = 0.0095;

struct HalfRounding {
  Eigen::Matrix3d matrix;    ///< the free entries are halves, none on the diagonal zero or subnormal
  double shift = 0.0;        ///< mean distance between directions of the two lobes, radians
  double detError = 0.0;     ///< |det(matrix) / det(given) - 1|
  bool moved = false;        ///< some entry is not the half nearest to it
  bool constrained = false;  ///< the nearest halves would have broken a bound below
};

/// Rounds the entries marked in `free` (row-major) to halves; the others stay as they are. `stored` is M or
/// its inverse, as `stores` says, with det != 0.
///
/// What is minimised is not the rounding of each number but the shift of the lobe: the mean distance on the
/// unit sphere between M x / |M x| and M' x / |M' x| over directions x of the cosine, an upper bound of the
/// transport distance between the two lobes. Under two bounds: free entries on the diagonal are normal
/// halves of the same sign (subnormal ones are flushed to zero on much hardware, and a zero makes matrices
/// singular), and the determinant keeps within kHalfDeterminantLimit. Where the given matrix is out of
/// reach of halves (90 degrees at the smallest alpha), the lobe moves as little as these bounds permit.
/// Throws std::invalid_argument where no matrix in reach meets them.
HalfRounding roundToHalf(const Eigen::Matrix3d& stored, MatrixStorage stores,
                         const std::array<bool, 9>& free);

}  // namespace ltcfit
