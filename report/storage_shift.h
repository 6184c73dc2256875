// How far storage moves a lobe.
#pragma once

#include <Eigen/Core>

#include "fit/lobe_fit.h"

namespace ltcfit {

/// Mean distance between the directions M x / |M x| and M' x / |M' x| over directions x of the cosine,
/// radians for small ones: an upper bound of the transport distance between the two lobes. Both det != 0.
double lobeShift(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

/// Of M, third column of length 1, stored as float32 and inverted in float32.
double float32Shift(const Eigen::Matrix3d& m);

/// Stored as halves as tables of the kind are (export/half_matrix.h): isotropic ones M^-1 over its middle
/// element, anisotropic ones M times a power of two. Entries that are 0 stay so. Infinite where an entry is
/// one that no half reaches.
double halfShift(const Eigen::Matrix3d& m, TableKind kind);

}  // namespace ltcfit
