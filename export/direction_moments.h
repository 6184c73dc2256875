// Lobes by a few moments: enough to tell one reading of a table's numbers from another, in microseconds.
#pragma once

#include <Eigen/Core>

#include "ltc/table.h"

namespace ltcfit {

/// First and second moments of a normalised distribution of directions.
struct DirectionMoments {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();    ///< of w: length in (0, 1], shorter for a wider lobe
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< of w w^T
};

/// The GGX lobe with F = 1, and what a table stores beside its matrix.
struct GgxMoments {
  DirectionMoments lobe;
  double norm = 0.0;     ///< directional albedo
  double fresnel = 0.0;  ///< Schlick-weighted albedo
};

/// By 256 samples: within about 0.01. Alphas below 1e-4 count as 1e-4; theta in [0, pi/2], any phi.
GgxMoments ggxMoments(const LobeParameters& parameters);

/// Of the LTC of M, by 256 samples; nothing like a lobe (zeros) where M has no inverse.
DirectionMoments ltcMoments(const Eigen::Matrix3d& m);

/// Euclidean distance of both moments: 0 for the same lobe, 0.05 for one that is off by 3 degrees, 2 for
/// opposite ones.
double momentDistance(const DirectionMoments& a, const DirectionMoments& b);

}  // namespace ltcfit
