#include "ltc/polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

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

// d (integral of the cosine over a polygon) / dP, where P moves each of its directions w to (I - P) w, is a
// sum over its edges. With n the inward normal of an edge's plane, the boundary moves outward by the angle
// n.P w at w, and what it sweeps counts by its cosine: the edge adds
//   integral over the arc of w.z (n.P w) dtheta = <P, n q^T>,  q = integral over the arc of w w.z dtheta,
// closed in the arc's ends. Edges along the horizon add nothing, since w.z = 0, so that the clip points need
// no derivative of their own; and an arc that comes up through the horizon grows from nothing.
void addArcGradient(const Vector3d& a, const Vector3d& b, Eigen::Matrix3d* gradient) {
  const Vector3d c = a.cross(b);
  const double s = c.norm();
  if (s == 0.0) return;
  const Vector3d n = c / s;
  const Vector3d u = a.normalized();
  const Vector3d v = n.cross(u);  // w(theta) = u cos theta + v sin theta
  const double d = a.dot(b);
  const double angle = std::atan2(s, d);
  const double inv = 1.0 / (s * s + d * d);
  const double cc = 0.5 * (angle + s * d * inv);
  const double ss = 0.5 * (angle - s * d * inv);
  const double cs = 0.5 * s * s * inv;
  *gradient += n * (u * (u.z() * cc + v.z() * cs) + v * (u.z() * cs + v.z() * ss)).transpose();
}

// Sum of the edges' angles times their normals' z, over the part above the horizon of the polygon with
// vertices vertex(0) .. vertex(n - 1); `gradient`, unless null, gains the edges' derivatives.
//
// Sutherland-Hodgman against z = 0, edge by edge: whenever the outline comes back up, the piece of horizon
// between the two crossings closes it. For a polygon that is not convex those pieces overlap with signs
// that cancel, so that no list of parts is needed.
template <class VertexAt>
double sumOverEdges(std::size_t n, const VertexAt& vertexAt, Eigen::Matrix3d* gradient) {
  double sum = 0.0;
  const auto add = [&](const Vector3d& a, const Vector3d& b) {
    sum += edgeIntegral(a, b).z();
    if (gradient != nullptr) addArcGradient(a, b, gradient);
  };
  bool haveExit = false;
  bool haveEntry = false;
  Vector3d exit = Vector3d::Zero();
  Vector3d firstEntry = Vector3d::Zero();
  const Vector3d& first = vertexAt(0);
  Vector3d a = first;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d b = i + 1 < n ? vertexAt(i + 1) : first;
    const bool aUp = a.z() > 0.0;
    const bool bUp = b.z() > 0.0;
    if (aUp && bUp) {
      add(a, b);
    } else if (aUp) {
      exit = horizonPoint(a, b);
      haveExit = true;
      add(a, exit);
    } else if (bUp) {
      const Vector3d entry = horizonPoint(a, b);
      if (haveExit) {
        sum += edgeIntegral(exit, entry).z();
      } else {
        firstEntry = entry;
        haveEntry = true;
      }
      add(entry, b);
    }
    a = b;
  }
  if (haveEntry) sum += edgeIntegral(exit, firstEntry).z();
  return sum;
}

}  // namespace

double polygonIrradiance(std::span<const Vector3d> vertices) {
  if (vertices.size() < 3) return 0.0;
  const auto at = [&](std::size_t i) -> const Vector3d& { return vertices[i]; };
  return sumOverEdges(vertices.size(), at, nullptr) * (0.5 * std::numbers::inv_pi);
}

double ltcPolygonIntegral(const Ltc& ltc, std::span<const Vector3d> vertices, Eigen::Matrix3d* gradient) {
  if (gradient != nullptr) gradient->setZero();
  if (vertices.size() < 3) return 0.0;
  const Eigen::Matrix3d& mInv = ltc.mInv();
  const auto at = [&](std::size_t i) -> Vector3d { return mInv * vertices[i]; };
  const double sign = ltc.det() < 0.0 ? -1.0 : 1.0;
  const double sum = sumOverEdges(vertices.size(), at, gradient);
  if (gradient != nullptr) *gradient *= sign * std::numbers::inv_pi;
  return sign * sum * (0.5 * std::numbers::inv_pi);
}

double ltcPolygonIntegral(const Ltc& ltc, std::span<const Vector3d> vertices) {
  return ltcPolygonIntegral(ltc, vertices, nullptr);
}

namespace {

template <class VertexAt>
Vector3d formFactorOf(std::size_t n, const VertexAt& vertexAt) {
  Vector3d sum = Vector3d::Zero();
  if (n < 3) return sum;
  for (std::size_t i = 0; i < n; ++i) sum += edgeIntegral(vertexAt(i), vertexAt((i + 1) % n));
  return sum * (0.5 * std::numbers::inv_pi);
}

}  // namespace

Vector3d vectorFormFactor(std::span<const Vector3d> vertices) {
  return formFactorOf(vertices.size(), [&](std::size_t i) -> const Vector3d& { return vertices[i]; });
}

namespace {

// In the cosine's configuration, pointing to the light whichever of the equivalent matrices is given.
Vector3d ltcFormFactor(const Ltc& ltc, std::span<const Vector3d> vertices) {
  const Vector3d f =
      formFactorOf(vertices.size(), [&](std::size_t i) -> Vector3d { return ltc.mInv() * vertices[i]; });
  return ltc.det() < 0.0 ? Vector3d(-f) : f;
}

}  // namespace

double ltcPolygonIntegralByProxySphere(const Ltc& ltc, std::span<const Vector3d> vertices) {
  return proxySphereFormFactor(ltcFormFactor(ltc, vertices));
}

double ltcPolygonIntegralBySphereTable(const Ltc& ltc, std::span<const Vector3d> vertices,
                                       const SphereTable& table) {
  const Vector3d f = ltcFormFactor(ltc, vertices);
  const double length = f.norm();
  return length > 0.0 ? length * table(f.z() / length, length) : 0.0;
}

double proxySphereFormFactor(const Vector3d& f) {
  const double length = f.norm();
  return std::max(0.0, (length * length + f.z()) / (length + 1.0));
}

}  // namespace ltcfit
