#include "render/light_plane.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

namespace ltcfit {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// An angle's sine below this is none: rounding of vertices that were meant to lie on a line.
constexpr double kStraight = 1e-12;

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double twiceArea(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return cross(b - a, c - a);
}

}  // namespace

std::vector<std::array<std::size_t, 3>> triangulate(std::span<const Vector2d> outline) {
  std::vector<std::array<std::size_t, 3>> triangles;
  double area = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i)
    area += cross(outline[i] - outline[0], outline[(i + 1) % outline.size()] - outline[0]);
  if (area == 0.0 || !std::isfinite(area)) return triangles;
  const double winding = area > 0.0 ? 1.0 : -1.0;
  std::vector<std::size_t> left(outline.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  const auto at = [&](std::size_t i) -> const Vector2d& { return outline[left[i % left.size()]]; };
  const auto isStraight = [&](std::size_t i) {
    const Vector2d in = at(i) - at(i + left.size() - 1);
    const Vector2d out = at(i + 1) - at(i);
    return std::abs(cross(in, out)) <= kStraight * in.norm() * out.norm();
  };
  const auto isEar = [&](std::size_t i) {
    const Vector2d& a = at(i + left.size() - 1);
    const Vector2d& b = at(i);
    const Vector2d& c = at(i + 1);
    if (!(winding * twiceArea(a, b, c) > 0.0)) return false;
    for (std::size_t k = 2; k + 1 < left.size(); ++k) {  // all others
      const Vector2d& p = at(i + k);
      if (p == a || p == b || p == c) continue;
      if (winding * twiceArea(a, b, p) >= 0.0 && winding * twiceArea(b, c, p) >= 0.0 &&
          winding * twiceArea(c, a, p) >= 0.0)
        return false;
    }
    return true;
  };
  while (left.size() >= 3) {
    std::size_t chosen = left.size();
    for (std::size_t i = 0; i < left.size() && chosen == left.size(); ++i)
      if (isStraight(i)) chosen = i;
    const bool straight = chosen < left.size();
    for (std::size_t i = 0; i < left.size() && chosen == left.size(); ++i)
      if (isEar(i)) chosen = i;
    if (chosen == left.size()) return triangles;  // crosses itself
    if (!straight)
      triangles.push_back(
          {left[(chosen + left.size() - 1) % left.size()], left[chosen], left[(chosen + 1) % left.size()]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(chosen));
  }
  return triangles;
}

LightPlane::LightPlane(const PolygonLight& light) : origin(light.vertices.at(0)) {
  const std::vector<Vector3d>& v = light.vertices;
  Vector3d area = Vector3d::Zero();
  for (std::size_t i = 0; i < v.size(); ++i) area += (v[i] - origin).cross(v[(i + 1) % v.size()] - origin);
  normal = area / area.norm();
  // the first edge with a length: vertices may be double
  Vector3d along = Vector3d::Zero();
  for (std::size_t i = 1; i < v.size() && along.squaredNorm() == 0.0; ++i) along = v[i] - origin;
  x = (along - along.dot(normal) * normal).normalized();
  y = normal.cross(x);
  for (const Vector3d& p : v) outline.emplace_back((p - origin).dot(x), (p - origin).dot(y));
  triangles = triangulate(outline);
}

}  // namespace ltcfit
