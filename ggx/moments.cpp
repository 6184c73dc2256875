#include "ggx/moments.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
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

// Cells of StretchedCubature that hold a kink are judged less well than smooth ones: a tighter tolerance for
// equal errors.
constexpr double kStretchedFactor = 0.2;

// Albedo, Schlick-weighted albedo, squared width about the mirror direction, first moment about it. Moments
// about a point inside the lobe, since those about the origin lose the width of a sharp one to rounding.
struct MomentIntegrand {
  static constexpr int kCount = 6;
  using Values = Eigen::Array<double, kCount, 1>;

  Vector3d wo;
  Vector3d mirror;
  double pilotWidth2;

  Values operator()(const Vector3d& wi, double eval) const {
    const double c = std::max(0.0, 1.0 - 0.5 * (wo + wi).norm());  // 1 - wo.wm, since |wo + wi| = 2 wo.wm
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

// Seven-point cubature over the hemisphere of Lobe::atStretched. There the lobe has unit scale and no
// singular point, so that plain adaptive quartering does: only the kinks along the horizon and the masking
// boundary are refined.
//
// It is for anisotropic lobes, whose curved ridges the cells in wi cannot follow at grazing view. For
// isotropic ones it is slower where alpha is small, since their tails crowd at the rim of the hemisphere: the
// width of a sharp lobe is only good to some percent here.
class StretchedCubature {
 public:
  using Values = MomentIntegrand::Values;

  StretchedCubature(const Lobe& lobe, const MomentIntegrand& integrand, double cellTolerance)
      : lobe_(lobe), integrand_(integrand), cellTolerance_(cellTolerance) {}

  // A face of the octahedron, cut into 4^kFirstCuts cells before any is judged: a pocket that the horizon
  // cuts off would have to be smaller than these to be missed.
  void add(const internal::Triangle& triangle, int cuts = 0) {
    if (cuts < kFirstCuts) {
      for (const internal::Triangle& part : triangle.quarters()) add(part, cuts + 1);
      return;
    }
    refine(triangle, estimate(triangle), 0);
  }

  const Values& values() const { return values_; }
  double error() const { return 3.0 * std::sqrt(squaredError_); }

 private:
  static constexpr int kFirstCuts = 2;
  // Quarterings after that; a cell is then 1e-4 rad wide and a step inside of it worth 1e-8.
  static constexpr int kMaxDepth = 11;

  Values at(const Vector3d& s) const {
    const StretchedNode node = lobe_.atStretched(s);
    if (node.measure == 0.0) return Values::Zero();
    return integrand_(node.wi, node.measure);
  }

  Values estimate(const internal::Triangle& t) const {
    const double det = t.p[0].dot(t.p[1].cross(t.p[2]));
    Values sum = Values::Zero();
    for (const internal::RulePoint& r : internal::radonRule()) {
      const Vector3d v = r.a * t.p[0] + r.b * t.p[1] + r.c * t.p[2];
      const double inv = 1.0 / v.norm();
      sum += 0.5 * r.weight * det * inv * inv * inv * at(inv * v);
    }
    return sum;
  }

  void refine(const internal::Triangle& triangle, const Values& whole, int depth) {
    const auto parts = triangle.quarters();
    std::array<Values, 4> values;
    for (std::size_t k = 0; k < 4; ++k) values[k] = estimate(parts[k]);
    const Values sum = (values[0] + values[1]) + (values[2] + values[3]);
    const Values difference = (sum - whole).abs();
    const double deviation = std::max(difference[0], difference[1]);
    if (deviation <= cellTolerance_ || depth >= kMaxDepth) {
      values_ += sum;
      // kinks and steps lie on both sides of the estimate: their errors add up like random ones
      squaredError_ += deviation * deviation;
      return;
    }
    for (std::size_t k = 0; k < 4; ++k) refine(parts[k], values[k], depth + 1);
  }

  const Lobe& lobe_;
  const MomentIntegrand& integrand_;
  double cellTolerance_;
  Values values_ = Values::Zero();
  double squaredError_ = 0.0;
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

template <class Cubature>
void addHemisphere(const Vector3d& wo, Cubature& cubature) {
  // The four upper faces of an octahedron with one edge plane through the view direction: the mirror
  // direction then lies on an edge, where subdivision finds it, and the halves of an isotropic lobe are
  // treated alike.
  const double length = std::hypot(wo.x(), wo.y());
  const double c = length > 0.0 ? wo.x() / length : 1.0;
  const double s = length > 0.0 ? wo.y() / length : 0.0;
  const Vector3d ring[4] = {{c, s, 0}, {-s, c, 0}, {-c, -s, 0}, {s, -c, 0}};
  for (int k = 0; k < 4; ++k) cubature.add({{Vector3d::UnitZ(), ring[k], ring[(k + 1) % 4]}});
}

}  // namespace

LobeMoments computeMoments(const Lobe& lobe, const MomentsOptions& options) {
  const Vector3d mirror(-lobe.wo().x(), -lobe.wo().y(), lobe.wo().z());
  const MomentIntegrand integrand{lobe.wo(), mirror, pilotWidth2(lobe, mirror)};
  LobeMoments m;
  MomentIntegrand::Values v;
  if (lobe.isIsotropic()) {
    internal::Cubature<MomentIntegrand> cubature(lobe, integrand, options.cellTolerance);
    addHemisphere(lobe.wo(), cubature);
    v = cubature.values();
    m.error = cubature.error();
  } else {
    StretchedCubature cubature(lobe, integrand, kStretchedFactor * options.cellTolerance);
    addHemisphere(lobe.wo(), cubature);
    v = cubature.values();
    m.error = cubature.error();
  }
  m.albedo = v[0];
  m.fresnel = v[1];
  const double inv = 1.0 / std::max(m.albedo, 1e-300);
  const Vector3d shift = inv * Vector3d(v[3], v[4], v[5]);
  m.mean = mirror + shift;
  // with q = E(1 - wi.mirror) = -mirror.shift:  1 - |mean|^2 = 2 q - |shift|^2
  const double sine2 = std::max(0.0, 2.0 * inv * v[2] - shift.squaredNorm());
  m.spread = std::atan2(std::sqrt(sine2), m.mean.norm());
  return m;
}

}  // namespace ltcfit
