#include "ggx/moments.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ggx/cubature.h"
#include "ggx/random.h"

namespace ltcfit {
namespace {

using Eigen::Vector3d;

// Samples for the first, rough estimate of the lobe's squared width; within 20 % is enough.
constexpr int kPilotSamples = 256;
// Weight of the relative change of the squared width against the absolute one of the albedo: a width to 1e-3
// or so is plenty, and its tails cost cells.
constexpr double kWidthWeight = 0.02;

// Albedo, Schlick-weighted albedo, squared width about the mirror direction, first moment about it. Moments
// about a point inside the lobe, since those about the origin lose the width of a sharp one to rounding.
struct MomentIntegrand {
  static constexpr int kCount = 6;
  using Values = Eigen::Array<double, kCount, 1>;

  Vector3d wo;
  Vector3d mirror;
  double pilotWidth2;

  Values operator()(const Vector3d& wi, double eval) const {
    const Vector3d h = wo + wi;
    const double c = std::max(0.0, 1.0 - 0.5 * h.norm());  // 1 - wo.wm, since |wo + wi| = 2 wo.wm
    const double c2 = c * c;
    const Vector3d d = wi - mirror;
    Values v;
    v << 1.0, c2 * c2 * c, 0.5 * d.squaredNorm(), d.x(), d.y(), d.z();
    return eval * v;
  }

  double deviation(const Values& difference) const {
    return std::max({std::abs(difference[0]), std::abs(difference[1]),
                     kWidthWeight * std::abs(difference[2]) / pilotWidth2});
  }
};

// E(1 - wi.m) from a few samples.
double pilotWidth2(const Lobe& lobe, const Vector3d& mirror) {
  const R2Sequence points(0);
  double sum = 0.0;
  double weight = 0.0;
  for (int i = 0; i < kPilotSamples; ++i) {
    const LobeSample s = lobe.sample(points(static_cast<std::uint64_t>(i)));
    sum += s.weight * 0.5 * (s.wi - mirror).squaredNorm();
    weight += s.weight;
  }
  return std::max(sum / std::max(weight, 1e-300), 1e-30);
}

}  // namespace

LobeMoments computeMoments(const Lobe& lobe, const MomentsOptions& options) {
  const Vector3d mirror(-lobe.wo().x(), -lobe.wo().y(), lobe.wo().z());
  const MomentIntegrand integrand{lobe.wo(), mirror, pilotWidth2(lobe, mirror)};
  internal::Cubature<MomentIntegrand> cubature(lobe, integrand, options.cellTolerance);
  // The hemisphere as the four upper faces of an octahedron with one edge plane through the view direction:
  // the mirror direction then lies on an edge, where subdivision finds it, and the halves of an isotropic
  // lobe are treated alike.
  const double length = std::hypot(lobe.wo().x(), lobe.wo().y());
  const double c = length > 0.0 ? lobe.wo().x() / length : 1.0;
  const double s = length > 0.0 ? lobe.wo().y() / length : 0.0;
  const Vector3d ring[4] = {{c, s, 0}, {-s, c, 0}, {-c, -s, 0}, {s, -c, 0}};
  for (int k = 0; k < 4; ++k) cubature.add({{Vector3d::UnitZ(), ring[k], ring[(k + 1) % 4]}});

  const auto& v = cubature.values();
  LobeMoments m;
  m.albedo = v[0];
  m.fresnel = v[1];
  const double inv = 1.0 / std::max(m.albedo, 1e-300);
  const Vector3d shift = inv * Vector3d(v[3], v[4], v[5]);
  m.mean = mirror + shift;
  // with q = E(1 - wi.mirror) = -mirror.shift:  1 - |mean|^2 = 2 q - |shift|^2
  const double sine2 = std::max(0.0, 2.0 * inv * v[2] - shift.squaredNorm());
  m.spread = std::atan2(std::sqrt(sine2), m.mean.norm());
  m.error = cubature.error();
  return m;
}

}  // namespace ltcfit
