#include "fit/polygon_lights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/refusal.h"
#include "ggx/random.h"
#include "ltc/ltc.h"
#include "ltc/polygon.h"

namespace ltcfit {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kSmallestLight = 0.02;
constexpr double kLargest = 1.5;
// Sides are s a and s / a with log a uniform up to this.
constexpr double kLogAspect = 0.7;
// Shares of the lights that are aimed at the lobe with their inside and with their rim. On nodes of both
// tables 0.1..0.4 and 0.3..0.8 change light_s, light_m, light_l by 2 %; without the rim, form is worse by a
// half: lobes narrower than the light show on its rim only.
constexpr double kInside = 0.25;
constexpr double kRim = 0.4;
constexpr double kUniform = 1.0 - kInside - kRim;
// Half-width of the rim in widths of the lobe; its share of the light's half-size is at most the second.
constexpr double kRimWidth = 2.0;
constexpr double kWidestRim = 0.5;
constexpr double kNarrowestRim = 1e-3;
// Share of the lobe down to which LightWeighting::kRelative is relative.
constexpr double kRelativeFloor = 0.01;
constexpr int kAboveForOneBelow = 16;

// The digits of `i` in base `b` behind the point: coordinates that are spread evenly and, with other bases,
// independently of each other (Halton).
double radicalInverse(std::uint64_t i, std::uint64_t b) {
  const double inverse = 1.0 / static_cast<double>(b);
  double value = 0.0;
  for (double scale = inverse; i > 0; i /= b, scale *= inverse) value += scale * static_cast<double>(i % b);
  return value;
}

double weightOf(LightWeighting weighting, double integral) {
  const double relative = kRelativeFloor / (kRelativeFloor + integral);
  switch (weighting) {
    case LightWeighting::kRelative:
      return relative;
    case LightWeighting::kMixed:
      return std::sqrt(relative);
    case LightWeighting::kAbsolute:
      break;
  }
  return 1.0;
}

Vector3d uniformDirection(const Vector2d& u) {
  const double r = std::sqrt(1.0 - u.x() * u.x());
  const double phi = 2.0 * std::numbers::pi * u.y();
  return {r * std::cos(phi), r * std::sin(phi), u.x()};
}

// Everything random about light `index`.
struct Draw {
  Vector2d direction;
  double size;
  double aspect;
  double angle;
  Vector2d place;  // on the light
};

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : directions_(mixSeed(seed, 40)) {
    Random random(mixSeed(seed, 41));
    for (double& x : shift_) x = random.uniform();
  }

  Draw operator()(int index) const {
    const auto i = static_cast<std::uint64_t>(index);
    const auto uniform = [&](std::size_t k) {
      constexpr std::array<std::uint64_t, 5> kBases{2, 3, 5, 7, 11};
      return std::fmod(radicalInverse(i, kBases[k]) + shift_[k], 1.0);
    };
    return {directions_(i), kSmallestLight * std::pow(kLargest / kSmallestLight, uniform(0)),
            std::exp(kLogAspect * (2.0 * uniform(1) - 1.0)), 2.0 * std::numbers::pi * uniform(2),
            Vector2d(uniform(3), uniform(4))};
  }

 private:
  R2Sequence directions_;
  std::array<double, 5> shift_{};
};

// A point of the square's frame between 1 - rim and 1 + rim, uniform over its area.
Vector2d onRim(const Vector2d& u, double rim) {
  const double inner = (1.0 - rim) * (1.0 - rim);
  const double outer = (1.0 + rim) * (1.0 + rim);
  const double t = std::sqrt(inner + u.y() * (outer - inner));
  const double side = 4.0 * u.x();
  const double along = 2.0 * (side - std::floor(side)) - 1.0;
  const double sign = std::fmod(std::floor(side), 2.0) == 0.0 ? t : -t;
  return side < 2.0 ? Vector2d(sign, t * along) : Vector2d(t * along, sign);
}

// Of a rectangle at distance 1 that faces the origin.
double solidAngle(const Vector2d& half) {
  const double x = half.x();
  const double y = half.y();
  return 4.0 * std::asin(x * y / std::sqrt((1.0 + x * x) * (1.0 + y * y)));
}

// Centre of a light whose point `place`, in half-sizes, lies in direction w; mirrored up to the upper
// hemisphere.
Vector3d aim(const Vector3d& w, const Vector2d& place, const Vector2d& half, double angle) {
  const auto [t1, t2] = tangents(w);
  const Vector2d p = Eigen::Rotation2Dd(angle) * place.cwiseProduct(half);
  const Vector3d centre = (w + p.x() * t1 + p.y() * t2).normalized();
  return {centre.x(), centre.y(), std::abs(centre.z())};
}

}  // namespace

std::string_view lightWeightingName(LightWeighting weighting) {
  switch (weighting) {
    case LightWeighting::kRelative:
      return "relative";
    case LightWeighting::kMixed:
      return "mixed";
    case LightWeighting::kAbsolute:
      break;
  }
  return "absolute";
}

LightWeighting lightWeightingFromName(std::string_view name) {
  for (const LightWeighting w :
       {LightWeighting::kAbsolute, LightWeighting::kRelative, LightWeighting::kMixed}) {
    if (name == lightWeightingName(w)) return w;
  }
  throw Refusal("weighting '" + std::string(name) + "' (absolute, relative or mixed)");
}

bool PolygonLightOptions::isValid(std::string* error) const {
  if (lights < 16 || lights > 65536) {
    *error = "lights = " + std::to_string(lights) + ", must be in 16..65536";
    return false;
  }
  if (!(sizeExponent >= -4.0 && sizeExponent <= 4.0)) {
    *error = "size exponent " + std::to_string(sizeExponent) + ", must be in -4..4";
    return false;
  }
  return true;
}

PolygonLights makePolygonLights(const ContourIntegrator& truth, double albedo, const Matrix3d& near,
                                const PolygonLightOptions& options) {
  const Ltc ltc(near);
  const Draws draws(options.seed);
  const double width = near.leftCols<2>().norm() / near.col(2).norm();
  const int inside = static_cast<int>(std::lround(kInside * options.lights));
  const int rim = static_cast<int>(std::lround(kRim * options.lights));
  const int below = options.lights / kAboveForOneBelow;

  PolygonLights out;
  out.lights.reserve(static_cast<std::size_t>(options.lights + below));
  for (int i = 0; i < options.lights; ++i) {
    const Draw d = draws(i);
    const Vector2d half(d.size * d.aspect, d.size / d.aspect);
    const double frame = std::clamp(kRimWidth * width / d.size, kNarrowestRim, kWidestRim);
    Vector3d centre = uniformDirection(d.direction);
    if (i < inside + rim) {
      const Vector2d place = i < inside ? Vector2d(2.0 * d.place - Vector2d::Ones()) : onRim(d.place, frame);
      centre = aim(ltc.sample(d.direction), place, half, d.angle);
    }
    const auto sized = [&](double factor) {
      return facingRectangle(centre, Vector2d::Zero(), factor * half, d.angle);
    };
    // with the light below the horizon that would have been mirrored to this one
    const Vector3d mirrored(centre.x(), centre.y(), -centre.z());
    const auto held = [&](double factor) {
      return std::max(0.0, ltcPolygonIntegral(ltc, sized(factor))) +
             std::max(0.0, ltcPolygonIntegral(
                               ltc, facingRectangle(mirrored, Vector2d::Zero(), factor * half, d.angle)));
    };
    const Quad quad = sized(1.0);
    const PolygonIntegral integral = truth.integrate(quad);
    out.integralError = std::max(out.integralError, integral.error / albedo);
    // A light whose random point follows the LTC has its centre at z with the LTC's mean density over the
    // light at z, or over its rim; against 1 / (2 pi) of the uniform ones. (On the sphere: the point is
    // uniform on the plane, which for large lights is not the same.)
    const double overLight = held(1.0) / solidAngle(half);
    const double overRim = std::max(0.0, held(1.0 + frame) - held(1.0 - frame)) /
                           (solidAngle((1.0 + frame) * half) - solidAngle((1.0 - frame) * half));
    const double density = kUniform + 2.0 * std::numbers::pi * (kInside * overLight + kRim * overRim);
    const double share = std::max(0.0, integral.value / albedo);
    out.lights.push_back(
        {quad, share,
         std::pow(d.size, -options.sizeExponent) / std::sqrt(density) * weightOf(options.weighting, share)});
  }
  for (int i = 0; i < below; ++i) {
    const Draw d = draws(i);
    const Vector3d up = uniformDirection(d.direction);
    // small enough to stay below the horizon: the half diagonal times the slope towards it is under |z|
    const double size = std::min(d.size, 0.5 * up.z());
    out.lights.push_back({facingRectangle({up.x(), up.y(), -up.z()}, Vector2d::Zero(), {size, size}, d.angle),
                          0.0, std::pow(std::max(size, kSmallestLight), -options.sizeExponent)});
  }
  double squares = 0.0;
  for (const IntegratedLight& l : out.lights) squares += l.weight * l.weight;
  const double scale = std::sqrt(static_cast<double>(out.lights.size()) / squares);
  for (IntegratedLight& l : out.lights) l.weight *= scale;
  out.integralError += std::abs(truth.hemisphere() / albedo - 1.0);
  return out;
}

}  // namespace ltcfit
