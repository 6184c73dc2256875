#include "report/random_lights.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace ltcfit {

using Eigen::Vector3d;

namespace {

// Rectangle about centre + offset on the plane through `centre`, which it faces.
Quad rectangle(const Vector3d& centre, double offsetX, double offsetY, double halfX, double halfY,
               double angle) {
  const Vector3d d = centre.normalized();
  const Vector3d helper = std::abs(d.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
  const Vector3d t1 = helper.cross(d).normalized();
  const Vector3d t2 = d.cross(t1);
  const Vector3d a = std::cos(angle) * t1 + std::sin(angle) * t2;
  const Vector3d b = d.cross(a);
  const Vector3d c = centre + offsetX * t1 + offsetY * t2;
  return {c - halfX * a - halfY * b, c + halfX * a - halfY * b, c + halfX * a + halfY * b,
          c - halfX * a + halfY * b};
}

}  // namespace

Quad randomFormQuad(const LobeMoments& moments, Random& random) {
  const double scale = 1.5 * moments.spread;
  const double x = scale * random.normal();
  const double y = scale * random.normal();
  const double halfX = scale * std::exp(0.7 * random.normal());
  const double halfY = scale * std::exp(0.7 * random.normal());
  return rectangle(moments.mean.normalized(), x, y, halfX, halfY, 2.0 * std::numbers::pi * random.uniform());
}

Quad randomLight(double size, Random& random) {
  const double z = random.uniform();
  const double phi = 2.0 * std::numbers::pi * random.uniform();
  const double r = std::sqrt(1.0 - z * z);
  const double a = std::exp(0.4 * random.normal());
  return rectangle({r * std::cos(phi), r * std::sin(phi), z}, 0.0, 0.0, size * a, size / a,
                   2.0 * std::numbers::pi * random.uniform());
}

}  // namespace ltcfit
