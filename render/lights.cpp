#include "render/lights.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "base/refusal.h"
#include "ltc/quad.h"

namespace ltcfit {
namespace {

// The outline in the light's plane, counterclockwise, for half-sizes of 1.
std::vector<Eigen::Vector2d> outline(LightShape shape) {
  std::vector<Eigen::Vector2d> out;
  if (shape == LightShape::kQuad) return {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const int n = shape == LightShape::kStar ? 10 : 24;
  const double step = 2.0 * std::numbers::pi / n;
  // so that the polygon of 24 has the disk's area
  const double diskRadius = std::sqrt(step / std::sin(step));
  for (int i = 0; i < n; ++i) {
    const double radius = shape == LightShape::kDisk ? diskRadius : i % 2 == 0 ? 1.0 : 0.4;
    out.emplace_back(radius * std::cos(step * i), radius * std::sin(step * i));
  }
  return out;
}

}  // namespace

LightShape lightShapeFromName(std::string_view name) {
  if (name == "quad") return LightShape::kQuad;
  if (name == "star") return LightShape::kStar;
  if (name == "disk-as-polygon") return LightShape::kDisk;
  throw Refusal("no light is named " + std::string(name));
}

PolygonLight makeLight(LightShape shape, const Eigen::Vector3d& centre, const Eigen::Vector3d& facing,
                       const Eigen::Vector2d& halfSize, double angle) {
  // clockwise seen from where it shines: counterclockwise about the direction away from there
  const Eigen::Vector3d away = -facing.normalized();
  const std::array<Eigen::Vector3d, 2> axes = tangents(away);
  const Eigen::Vector3d x = std::cos(angle) * axes[0] + std::sin(angle) * axes[1];
  const Eigen::Vector3d y = away.cross(x);
  PolygonLight light;
  for (const Eigen::Vector2d& p : outline(shape))
    light.vertices.push_back(centre + p.x() * halfSize.x() * x + p.y() * halfSize.y() * y);
  return light;
}

}  // namespace ltcfit
