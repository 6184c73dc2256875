// The symmetries of anisotropic lobes by which a table of one quadrant and one order of roughness serves all.
#pragma once

#include <Eigen/Core>

#include "ltc/table.h"

namespace ltcfit {

/// A lobe of the table, and the mirror or swap of x and y that leads from it to the lobe asked for.
struct CanonicalLobe {
  LobeParameters parameters;  ///< alphaX >= alphaY, phi in [0, pi/2]
  Eigen::Matrix3d map;        ///< orthogonal, own inverse or a product of two that are; z stays
};

/// KT et al. 2022, eq. 13 (quadrants of phi) and eq. 15 (alpha_y > alpha_x swaps x and y and mirrors phi).
/// phi may be any finite angle.
CanonicalLobe canonicalLobe(const LobeParameters& parameters);

/// The matrix of the lobe asked for: map T map^T. The paper multiplies by `map` on the left only; on the
/// right it changes no lobe, keeps det M > 0 so that no winding needs reversing, and makes M itself, not only
/// its lobe, continuous where two branches meet, if the table has the symmetries of eq. 16 and is turned
/// about z where alpha_x = alpha_y.
Eigen::Matrix3d fromCanonical(const CanonicalLobe& lobe, const Eigen::Matrix3d& t);

}  // namespace ltcfit
