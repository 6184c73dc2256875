// Irradiance of polygons under the clamped cosine, and so the integral of an LTC over a polygonal light.
#pragma once

#include <Eigen/Core>
#include <span>

#include "ltc/ltc.h"
#include "ltc/sphere.h"

namespace ltcfit {

/// Form factor of a polygon at the origin with normal +z: the integral of max(0, w.z) / pi over the
/// directions it covers, in [-1, 1] (Heitz et al. 2016, eq. 11; Heitz 2017). `vertices` are points (any
/// length > 0, all edges seen under less than pi), in one plane, convex or not; closed from
/// last to first. Positive where they run counterclockwise seen from above, from +z down to the origin; a
/// light that emits from one side only takes max(0, value), a two-sided one |value|. Exact clipping at the
/// horizon. Fewer than three vertices give 0. An edge that passes through the origin contributes nothing.
double polygonIrradiance(std::span<const Eigen::Vector3d> vertices);

/// Integral of the LTC over a polygonal light, in [-1, 1]: polygonIrradiance of M^-1 times the vertices
/// (Heitz et al. 2016, eq. 10). For det M < 0 the winding flips; the sign is turned back, so that the result
/// does not depend on which of the equivalent matrices is given.
double ltcPolygonIntegral(const Ltc& ltc, std::span<const Eigen::Vector3d> vertices);

/// As ltcPolygonIntegral, with the derivative: `gradient`(r, c) becomes d value / d P(r, c) at P = 0 for the
/// LTC of M (I + P). Continuous in M and in the vertices, also where a vertex crosses the horizon; finite for
/// every edge. For edges through the origin, whose plane is undefined, it is 0, as their value is.
double ltcPolygonIntegral(const Ltc& ltc, std::span<const Eigen::Vector3d> vertices,
                          Eigen::Matrix3d* gradient);

/// Vector form factor F of a polygon without clipping: 1/(2 pi) sum of edge angles times edge normals; its
/// z is the form factor of a polygon wholly above the horizon (Heitz 2017; Hill and Heitz 2016).
Eigen::Vector3d vectorFormFactor(std::span<const Eigen::Vector3d> vertices);

/// The shortcut that engines take for horizon clipping: form factor of the sphere with vector form factor F,
/// by the fit max(0, (|F|^2 + F.z) / (|F| + 1)) (Hill and Heitz 2016). Not exact: for polygons through the
/// horizon it is off by up to 0.14.
double proxySphereFormFactor(const Eigen::Vector3d& vectorFormFactor);

/// As ltcPolygonIntegral through that shortcut, in [0, 1]: what an engine that takes it shades with.
double ltcPolygonIntegralByProxySphere(const Ltc& ltc, std::span<const Eigen::Vector3d> vertices);

/// As that, with the sphere's form factor looked up in a table: what engines do that store one.
double ltcPolygonIntegralBySphereTable(const Ltc& ltc, std::span<const Eigen::Vector3d> vertices,
                                       const SphereTable& table);

}  // namespace ltcfit
