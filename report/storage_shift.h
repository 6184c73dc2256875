// How far storage moves a lobe.
#pragma once

#include <Eigen/Core>

#include "fit/matrix_family.h"

namespace ltcfit {

/// Mean distance between the directions M x / |M x| and M' x / |M' x| over directions x of the cosine,
/// radians for small ones: an upper bound of the transport distance between the two lobes. Both det != 0.
double lobeShift(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

/// Of M, third column of length 1, stored as float32 and inverted in float32.
double float32Shift(const Eigen::Matrix3d& m);

/// Of M^-1 over its middle element stored as halves (export/half_matrix.h); entries that the family leaves 0
/// stay so. Infinite where an entry is one that no half reaches.
double halfShift(const Eigen::Matrix3d& m, MatrixFamily family);

}  // namespace ltcfit
