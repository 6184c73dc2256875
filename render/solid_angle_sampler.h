// Directions spread evenly over the part of a polygon that a point sees above its horizon.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace ltcfit {

/// A triangle on the unit sphere. Solid angles keep their relative accuracy down to triangles far below what
/// acos of cosines resolves.
class SphericalTriangle {
 public:
  /// Points in space, of any length, of either winding. Seen edge on, or with the origin on its outline, the
  /// triangle is empty.
  SphericalTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

  double solidAngle() const { return solidAngle_; }  ///< steradians, 0..2 pi, finite

  /// Maps the unit square onto the triangle so that equal areas become equal solid angles (the map of Arvo
  /// 1995). Unit to rounding.
  Eigen::Vector3d sample(const Eigen::Vector2d& u) const;

 private:
  Eigen::Vector3d a_, b_, c_;  // unit
  double solidAngle_ = 0.0;
  double volume_ = 0.0;  // |det(a, b, c)|
  double toC_ = 0.0;     // a.c + b.c
  double toB_ = 0.0;     // 1 + a.b
};

class SolidAngleSampler {
 public:
  /// Takes the place of what was there. `vertices` are relative to the point, in its shading frame;
  /// `triangles` are indices into them. What is below z = 0 is cut off.
  void set(std::span<const Eigen::Vector3d> vertices, std::span<const std::array<std::size_t, 3>> triangles);

  /// Steradians, the sum over the triangles; 0: nothing is seen, and there is nothing to sample.
  double solidAngle() const { return total_; }

  /// A direction of density 1 / solidAngle().
  Eigen::Vector3d sample(const Eigen::Vector2d& u) const;

 private:
  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

  std::vector<SphericalTriangle> triangles_;
  std::vector<double> ends_;  // sums of the solid angles
  double total_ = 0.0;
};

}  // namespace ltcfit
