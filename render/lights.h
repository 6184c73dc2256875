// Polygonal lights of the shapes that the scenes use.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "render/scene.h"

namespace ltcfit {

/// Shapes by their names on the command line: "quad", "star" (five points, ten vertices, not convex),
/// "disk-as-polygon" (24 vertices, of the disk's area).
enum class LightShape { kQuad, kStar, kDisk };

/// Throws Refusal for another name.
LightShape lightShapeFromName(std::string_view name);

/// A one-sided light of radiance 1 at `centre` that emits along `facing` (any length > 0), turned by `angle`
/// (radians) about it; half-sizes as of its rectangle, and of star and disk the radii along the two axes.
PolygonLight makeLight(LightShape shape, const Eigen::Vector3d& centre, const Eigen::Vector3d& facing,
                       const Eigen::Vector2d& halfSize, double angle = 0.0);

}  // namespace ltcfit
