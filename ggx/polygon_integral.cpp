#include "ggx/polygon_integral.h"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "ggx/cubature.h"

namespace ltcfit {
namespace {

using Eigen::Vector3d;

using internal::Triangle;

struct EvalIntegrand {
  static constexpr int kCount = 1;
  using Values = Eigen::Array<double, 1, 1>;
  Values operator()(const Vector3d&, double eval) const { return Values(eval); }
  double deviation(const Values& difference) const { return std::abs(difference[0]); }
};

// The part of a convex polygon on the positive side of the plane through the origin with this normal.
std::vector<Vector3d> clip(const std::vector<Vector3d>& polygon, const Vector3d& normal) {
  std::vector<Vector3d> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& a = polygon[i];
    const Vector3d& b = polygon[(i + 1) % polygon.size()];
    const double da = normal.dot(a);
    const double db = normal.dot(b);
    if (da >= 0.0) out.push_back(a);
    if ((da < 0.0) != (db < 0.0)) {
      const Vector3d c = a + (b - a) * (da / (da - db));
      out.push_back(c - normal * normal.dot(c));  // exactly on the plane
    }
  }
  return out;
}

}  // namespace

PolygonIntegral integrateLobeOverPolygon(const Lobe& lobe, std::span<const Vector3d> vertices,
                                         const PolygonIntegralOptions& options) {
  const EvalIntegrand integrand;
  internal::Cubature<EvalIntegrand> cubature(lobe, integrand, options.cellTolerance);
  // The plane of incidence, in which the ridge of an isotropic lobe at grazing view lies: cells with an edge
  // along it can follow the ridge.
  const Vector3d& wo = lobe.wo();
  const double length = std::hypot(wo.x(), wo.y());
  const Vector3d side = length > 0.0 ? Vector3d(-wo.y() / length, wo.x() / length, 0.0) : Vector3d::UnitY();
  // A fan from the first vertex; for a polygon that is not convex the signed triangles cancel outside of it.
  for (std::size_t i = 2; i < vertices.size(); ++i) {
    const std::vector<Vector3d> above = clip({vertices[0], vertices[i - 1], vertices[i]}, Vector3d::UnitZ());
    for (const Vector3d& normal : {side, Vector3d(-side)}) {
      const std::vector<Vector3d> part = clip(above, normal);
      for (std::size_t k = 2; k < part.size(); ++k) cubature.add({{part[0], part[k - 1], part[k]}});
    }
  }
  return {cubature.values()[0], cubature.error(), cubature.evaluations()};
}

}  // namespace ltcfit
