#include "ltc/sphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ltcfit {
namespace {

// Below this tangent five terms of atan's series are exact to a double.
constexpr double kSmallArc = 0.03;

}  // namespace

double sphereFormFactor(double cosOmega, double sinSigma) {
  return sinSigma * sinSigma * cosOmega;
}

double sphereFormFactorClipped(double cosOmega, double sinSigma) {
  if (cosOmega >= sinSigma) return sphereFormFactor(cosOmega, sinSigma);
  if (cosOmega <= -sinSigma) return 0.0;
  // The cap crosses the horizon. By Stokes, pi E = 1/2 contour integral of (w x dw).z over the boundary of
  // the visible part. With the cap's circle w(t) = cos s d + sin s (cos t e1 + sin t e2), e1 pointing up, the
  // arc above the horizon is |t| < t0, cos t0 = -cot s cot o, and contributes
  //   t0 sin^2 s cos o - cos s sin s sin o sin t0;
  // the horizon between its ends, |phi| < phi0 with cos phi0 = cos s / sin o, contributes phi0.
  const double cosSigma = std::sqrt(std::max(0.0, 1.0 - sinSigma * sinSigma));
  // With r = sqrt(sin^2 s - cos^2 o): sin t0 = r / (sin s sin o), tan phi0 = r / cos s. The last two terms
  // cancel to third order for small spheres, where their difference is taken from its series.
  const double r = std::sqrt(std::max(0.0, sinSigma * sinSigma - cosOmega * cosOmega));
  const double t0 = std::atan2(r, -cosSigma * cosOmega);
  const double q = r / cosSigma;
  const double q2 = q * q;
  const double arcs =
      q < kSmallArc
          ? r / cosSigma * (sinSigma * sinSigma - q2 * (1.0 / 3 - q2 * (1.0 / 5 - q2 * (1.0 / 7 - q2 / 9))))
          : std::atan2(r, cosSigma) - cosSigma * r;
  const double area = t0 * sinSigma * sinSigma * cosOmega + arcs;
  return std::clamp(area * std::numbers::inv_pi, 0.0, sinSigma * sinSigma);
}

double sphereTableValue(double cosOmega, double length) {
  if (length <= 0.0) return std::max(0.0, cosOmega);
  return sphereFormFactorClipped(cosOmega, std::sqrt(length)) / length;
}

SphereTable::SphereTable(std::size_t size) : size_(size) {
  values_.reserve(size * size);
  const auto last = static_cast<double>(size - 1);
  for (std::size_t y = 0; y < size; ++y)
    for (std::size_t x = 0; x < size; ++x)
      values_.push_back(
          sphereTableValue(2.0 * static_cast<double>(x) / last - 1.0, static_cast<double>(y) / last));
}

double SphereTable::operator()(double cosOmega, double length) const {
  const auto last = static_cast<double>(size_ - 1);
  const double x = std::clamp(0.5 * (cosOmega + 1.0), 0.0, 1.0) * last;
  const double y = std::clamp(length, 0.0, 1.0) * last;
  const auto x0 = std::min(static_cast<std::size_t>(x), size_ - 2);
  const auto y0 = std::min(static_cast<std::size_t>(y), size_ - 2);
  const double* row = values_.data() + y0 * size_ + x0;
  const double fx = x - static_cast<double>(x0);
  const double fy = y - static_cast<double>(y0);
  return std::lerp(std::lerp(row[0], row[1], fx), std::lerp(row[size_], row[size_ + 1], fx), fy);
}

}  // namespace ltcfit
