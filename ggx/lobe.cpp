#include "ggx/lobe.h"

#include <cmath>
#include <numbers>

namespace ltcfit {

void Lobe::evalBatch(std::span<const double> x, std::span<const double> y, std::span<const double> z,
                     std::span<double> evalOut, std::span<double> pdfOut) const {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Eigen::Vector3d wi(x[i], y[i], z[i]);
    evalOut[i] = eval(wi);
    pdfOut[i] = pdf(wi);
  }
}

Eigen::Vector3d viewDirection(double theta, double phi) {
  if (theta >= 0.5 * std::numbers::pi) return {std::cos(phi), std::sin(phi), 0.0};
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

}  // namespace ltcfit
