// The size of a lobe, from its samples: where fits begin.
#pragma once

#include <Eigen/Core>

#include "ggx/lobe.h"

namespace ltcfit {

/// Median deviations of a lobe's directions in the frame of its mean direction, radians for narrow lobes.
/// Medians, because the heavy tails of GGX dominate every moment of a sharp lobe: at grazing view the core
/// narrows like alpha^2 across the plane of incidence while the standard deviation does not.
struct LobeShape {
  double inPlane;  ///< along X of frameAbout(mean)
  double across;   ///< along Y
};

/// From a few hundred quasi-random samples of the lobe. `mean` is its mean direction, y = 0.
LobeShape measureLobeShape(const Lobe& lobe, const Eigen::Vector3d& mean);

/// The matrix whose LTC has the direction and the median deviations given, in the frame of `mean`: a start
/// that overlaps the lobe, made from nothing but the lobe.
Eigen::Matrix3d matrixOfShape(const LobeShape& shape, const Eigen::Vector3d& mean);

}  // namespace ltcfit
