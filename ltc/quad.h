// Rectangular lights.
#pragma once

#include <Eigen/Core>
#include <array>

namespace ltcfit {

/// A rectangle in the shading frame, counterclockwise seen from above.
using Quad = std::array<Eigen::Vector3d, 4>;

/// Two unit vectors perpendicular to the unit vector `d` and to each other, right-handed with it.
std::array<Eigen::Vector3d, 2> tangents(const Eigen::Vector3d& d);

/// The rectangle on the plane through `centre` that faces the origin, moved in that plane by an offset and
/// turned by `angle` (radians); half-sizes and offsets are lengths. `centre` of any length > 0.
Quad facingRectangle(const Eigen::Vector3d& centre, const Eigen::Vector2d& offset,
                     const Eigen::Vector2d& halfSize, double angle);

}  // namespace ltcfit
