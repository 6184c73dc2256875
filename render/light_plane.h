// A light's polygon in its own plane: what is made of it once, for all points that it lights.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "render/scene.h"

namespace ltcfit {

/// Whether a half-line from p towards +x crosses the edge from `a` to `b`. An odd number of crossings of an
/// outline's edges puts p inside; a point on the outline is either.
inline bool crossesEdge(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (a.y() > p.y()) != (b.y() > p.y()) &&
         p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
}

/// Cuts a simple polygon, convex or not and of either winding, into triangles (indices into `outline`, wound
/// as the polygon is) by clipping ears. Vertices without an angle are dropped, so that there may be fewer
/// than n - 2 triangles; none for an outline without area. An outline that crosses itself gives some
/// triangles.
std::vector<std::array<std::size_t, 3>> triangulate(std::span<const Eigen::Vector2d> outline);

struct LightPlane {
  // Orthonormal; the origin is vertex 0, x runs towards vertex 1, and seen from the tip of the normal
  // vertices run counterclockwise: the light shines to the other side. All NaN without area.
  Eigen::Vector3d origin;
  Eigen::Vector3d x;
  Eigen::Vector3d y;
  Eigen::Vector3d normal;
  std::vector<Eigen::Vector2d> outline;  ///< in x and y
  std::vector<std::array<std::size_t, 3>> triangles;

  explicit LightPlane(const PolygonLight& light);

  /// Whether a point of the plane, in x and y, is inside the outline.
  bool contains(const Eigen::Vector2d& p) const {
    bool inside = false;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++)
      inside ^= crossesEdge(outline[j], outline[i], p);
    return inside;
  }
};

}  // namespace ltcfit
