#include "ltc/quad.h"

#include <Eigen/Geometry>
#include <cmath>

namespace ltcfit {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::array<Vector3d, 2> tangents(const Vector3d& d) {
  const Vector3d helper = std::abs(d.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
  const Vector3d first = helper.cross(d).normalized();
  return {first, d.cross(first)};
}

Quad facingRectangle(const Vector3d& centre, const Vector2d& offset, const Vector2d& halfSize, double angle) {
  const Vector3d d = centre.normalized();
  const auto [t1, t2] = tangents(d);
  const Vector3d a = std::cos(angle) * t1 + std::sin(angle) * t2;
  const Vector3d b = d.cross(a);
  const Vector3d c = centre + offset.x() * t1 + offset.y() * t2;
  const Vector3d x = halfSize.x() * a;
  const Vector3d y = halfSize.y() * b;
  return {c - x - y, c + x - y, c + x + y, c - x + y};
}

}  // namespace ltcfit
