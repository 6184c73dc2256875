#include "ltc/sphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ltcfit {

double sphereFormFactor(double cosOmega, double sinSigma) {
  return sinSigma * sinSigma * cosOmega;
}

double sphereFormFactorClipped(double cosOmega, double sinSigma) {
  const double sinOmega = std::sqrt(std::max(0.0, 1.0 - cosOmega * cosOmega));
  if (cosOmega >= sinSigma) return sphereFormFactor(cosOmega, sinSigma);
  if (cosOmega <= -sinSigma) return 0.0;
  // The cap crosses the horizon. By Stokes, pi E = 1/2 contour integral of (w x dw).z over the boundary of
  // the visible part. With the cap's circle w(t) = cos s d + sin s (cos t e1 + sin t e2), e1 pointing up, the
  // arc above the horizon is |t| < t0, cos t0 = -cot s cot o, and contributes
  //   t0 sin^2 s cos o - cos s sin s sin o sin t0;
  // the horizon between its ends, |phi| < phi0 with cos phi0 = cos s / sin o, contributes phi0.
  const double cosSigma = std::sqrt(std::max(0.0, 1.0 - sinSigma * sinSigma));
  const double cosT0 = std::clamp(-cosSigma * cosOmega / (sinSigma * sinOmega), -1.0, 1.0);
  const double t0 = std::acos(cosT0);
  const double sinT0 = std::sqrt(1.0 - cosT0 * cosT0);
  const double phi0 = std::acos(std::clamp(cosSigma / sinOmega, -1.0, 1.0));
  const double area = t0 * sinSigma * sinSigma * cosOmega - cosSigma * sinSigma * sinOmega * sinT0 + phi0;
  return std::max(0.0, area) * std::numbers::inv_pi;
}

}  // namespace ltcfit
