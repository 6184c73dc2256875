#include "ggx/ggx.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace ltcfit {

using Eigen::Vector3d;

double ggxD(const Vector3d& wm, GgxAlpha alpha) {
  if (wm.z() < 0.0) return 0.0;
  const double sx = wm.x() / alpha.x;
  const double sy = wm.y() / alpha.y;
  const double q = sx * sx + sy * sy + wm.z() * wm.z();
  return 1.0 / (std::numbers::pi * alpha.x * alpha.y * q * q);
}

double ggxLambda(const Vector3d& w, GgxAlpha alpha) {
  const double ax = alpha.x * w.x();
  const double ay = alpha.y * w.y();
  // (sqrt(1 + t) - 1) / 2 in the form that keeps its digits for small t (alpha -> 0)
  const double t = (ax * ax + ay * ay) / (w.z() * w.z());
  if (std::isinf(t)) return t;
  return 0.5 * t / (1.0 + std::sqrt(1.0 + t));
}

double ggxG1(const Vector3d& w, GgxAlpha alpha) {
  return 1.0 / (1.0 + ggxLambda(w, alpha));
}

double ggxG2(const Vector3d& wo, const Vector3d& wi, GgxAlpha alpha) {
  return 1.0 / (1.0 + ggxLambda(wo, alpha) + ggxLambda(wi, alpha));
}

Vector3d sampleGgxVisibleNormal(const Vector3d& wo, GgxAlpha alpha, const Eigen::Vector2d& u) {
  // Stretch to the configuration of roughness 1, where the visible normals are those of a hemisphere.
  const Vector3d v = Vector3d(alpha.x * wo.x(), alpha.y * wo.y(), wo.z()).normalized();
  const double length = std::hypot(v.x(), v.y());
  const Vector3d t1 = length > 0.0 ? Vector3d(-v.y() / length, v.x() / length, 0.0) : Vector3d::UnitX();
  const Vector3d t2 = v.cross(t1);
  // Uniform on the hemisphere's projection along v: a half disk next to a half ellipse squeezed by v.z.
  const double r = std::sqrt(u.x());
  const double phi = 2.0 * std::numbers::pi * u.y();
  const double p1 = r * std::cos(phi);
  const double s = 0.5 * (1.0 + v.z());
  const double p2 = (1.0 - s) * std::sqrt(std::max(0.0, 1.0 - p1 * p1)) + s * r * std::sin(phi);
  const Vector3d nh = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1.0 - p1 * p1 - p2 * p2)) * v;
  return Vector3d(alpha.x * nh.x(), alpha.y * nh.y(), std::max(0.0, nh.z())).normalized();
}

}  // namespace ltcfit
