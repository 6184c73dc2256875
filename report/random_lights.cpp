#include "report/random_lights.h"

#include <cmath>
#include <numbers>

namespace ltcfit {

using Eigen::Vector3d;

Quad randomFormQuad(const LobeMoments& moments, Random& random) {
  const double scale = 1.5 * moments.spread;
  const double x = scale * random.normal();
  const double y = scale * random.normal();
  const double halfX = scale * std::exp(0.7 * random.normal());
  const double halfY = scale * std::exp(0.7 * random.normal());
  return facingRectangle(moments.mean.normalized(), {x, y}, {halfX, halfY},
                         2.0 * std::numbers::pi * random.uniform());
}

Quad randomLight(double size, Random& random) {
  const double z = random.uniform();
  const double phi = 2.0 * std::numbers::pi * random.uniform();
  const double r = std::sqrt(1.0 - z * z);
  const double a = std::exp(0.4 * random.normal());
  return facingRectangle({r * std::cos(phi), r * std::sin(phi), z}, {0.0, 0.0}, {size * a, size / a},
                         2.0 * std::numbers::pi * random.uniform());
}

}  // namespace ltcfit
