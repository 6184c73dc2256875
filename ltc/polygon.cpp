#include "ltc/polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace ltcfit {

using Eigen::Vector3d;

namespace {

// Angle between a and b times the unit normal of their plane: acos(a.b) (a x b) / |a x b| for unit vectors.
// atan2 keeps its digits where acos loses them, for edges that nearly vanish or nearly span pi, and needs no
// normalised input.
Vector3d edgeIntegral(const Vector3d& a, const Vector3d& b) {
  const Vector3d c = a.cross(b);
  const double s = c.norm();
  const double d = a.dot(b);
  if (s == 0.0) return Vector3d::Zero();  // no edge, or one through the origin: the plane is undefined
  return c * (std::atan2(s, d) / s);
}

// Where the edge a-b crosses the horizon.
Vector3d horizonPoint(const Vector3d& a, const Vector3d& b) {
  Vector3d p = (a * b.z() - b * a.z()) / (b.z() - a.z());
  p.z() = 0.0;
  return p;
}

}  // namespace

double polygonIrradiance(std::span<const Vector3d> vertices) {
  if (vertices.size() < 3) return 0.0;
  // Sutherland-Hodgman against z = 0, edge by edge: whenever the outline comes back up, the piece of horizon
  // between the two crossings closes it. For a polygon that is not convex those pieces overlap with signs
  // that cancel, so that no list of parts is needed.
  double sum = 0.0;
  bool haveExit = false;
  bool haveEntry = false;
  Vector3d exit = Vector3d::Zero();
  Vector3d firstEntry = Vector3d::Zero();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vector3d& a = vertices[i];
    const Vector3d& b = vertices[(i + 1) % vertices.size()];
    const bool aUp = a.z() > 0.0;
    const bool bUp = b.z() > 0.0;
    if (aUp && bUp) {
      sum += edgeIntegral(a, b).z();
    } else if (aUp) {
      exit = horizonPoint(a, b);
      haveExit = true;
      sum += edgeIntegral(a, exit).z();
    } else if (bUp) {
      const Vector3d entry = horizonPoint(a, b);
      if (haveExit) {
        sum += edgeIntegral(exit, entry).z();
      } else {
        firstEntry = entry;
        haveEntry = true;
      }
      sum += edgeIntegral(entry, b).z();
    }
  }
  if (haveEntry) sum += edgeIntegral(exit, firstEntry).z();
  return sum / (2.0 * std::numbers::pi);
}

double ltcPolygonIntegral(const Ltc& ltc, std::span<const Vector3d> vertices) {
  std::vector<Vector3d> transformed(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) transformed[i] = ltc.mInv() * vertices[i];
  const double value = polygonIrradiance(transformed);
  return ltc.det() < 0.0 ? -value : value;
}

Vector3d vectorFormFactor(std::span<const Vector3d> vertices) {
  Vector3d sum = Vector3d::Zero();
  if (vertices.size() < 3) return sum;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    sum += edgeIntegral(vertices[i], vertices[(i + 1) % vertices.size()]);
  }
  return sum / (2.0 * std::numbers::pi);
}

double proxySphereFormFactor(const Vector3d& f) {
  const double length = f.norm();
  return std::max(0.0, (length * length + f.z()) / (length + 1.0));
}

}  // namespace ltcfit
