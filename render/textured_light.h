// The colour that a textured light adds to an LTC integral, in double: what ltc_textured.glsl does.
#pragma once

#include <Eigen/Core>
#include <span>

#include "render/prefilter.h"

namespace ltcfit {

/// Where a prefiltered texture is read for one light seen from one point.
struct TextureFetch {
  Eigen::Vector2d uv;  ///< on the light: (0, 0), (1, 0), (1, 1), (0, 1) at its vertices; any finite value
  double sigma;        ///< of the filter, in units of the root of the light's area; > 0, finite
};

/// In the frame of the cosine the point's projection onto the light's plane, and sigma = sqrt(r^2 / (2 A))
/// with r the distance of the plane and A the light's area there (Heitz et al. 2016, section 5.4). `inverse`
/// takes directions of the shading frame, in which the vertices are, to the cosine; its scale has no meaning.
/// A parallelogram; of another plane quadrilateral the parallelogram nearest to it. Lights without area and
/// planes through the point give finite values without a meaning.
TextureFetch textureFetch(const Eigen::Matrix3d& inverse, std::span<const Eigen::Vector3d, 4> vertices);

/// The texture at `uv` of the light as a sampler reads it: trilinear, clamped to the edge and to its levels.
Eigen::Vector3d sampleTrilinear(const PrefilteredTexture& texture, const Eigen::Vector2d& uv, double lod);

/// I_L of Heitz et al. 2016, eq. 14, approximated: the mean radiance of the light under the lobe, which
/// multiplies the lobe's integral over the light.
Eigen::Vector3d fetchPrefiltered(const PrefilteredTexture& texture, const Eigen::Matrix3d& inverse,
                                 std::span<const Eigen::Vector3d, 4> vertices);

}  // namespace ltcfit
