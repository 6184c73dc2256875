// The true integral of a lobe over a polygonal light: what the closed form of an LTC is judged by.
#pragma once

#include <Eigen/Core>
#include <span>

#include "ggx/lobe.h"

namespace ltcfit {

struct PolygonIntegralOptions {
  /// A cell is split while its estimate and that of its four quarters differ by more than this. The error of
  /// the sum is of this order (see the test), since an accepted cell is usually much better than its bound.
  double cellTolerance = 1e-6;
};

struct PolygonIntegral {
  double value = 0.0;  ///< integral of eval(wi) over the part of the polygon above the horizon
  double error = 0.0;  ///< sum over accepted cells of |cell - its quarters| / 15: a pessimistic estimate
  std::size_t evaluations = 0;  ///< calls of eval
};

/// Integral of lobe.eval over the directions that a planar polygon covers, dimensionless. `vertices` are
/// points in the shading frame (not necessarily unit, in one plane that misses the origin), convex or not.
/// Positive where the vertices run counterclockwise seen from above (from +z down to the origin), negative
/// otherwise: the winding of ltc/polygon.h. Fewer than three vertices give 0.
///
/// Adaptive cubature (Radon's 7-point rule of degree 5 on triangles, clipped to the horizon), with cells
/// split until they are small in the lobe's own coordinates: a sharp lobe inside a large light is not missed.
PolygonIntegral integrateLobeOverPolygon(const Lobe& lobe, std::span<const Eigen::Vector3d> vertices,
                                         const PolygonIntegralOptions& options = {});

}  // namespace ltcfit
