#include "tailor/lobe_distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "ggx/random.h"
#include "ltc/axis.h"

namespace ltcfit {

std::vector<LookUp> drawLookUps(const LobeDistribution& distribution, std::size_t count, double alphaFloor,
                                std::uint64_t seed) {
  // in an order in which neighbours are alike, so that evenly spread quantiles are evenly spread lobes
  std::vector<LobeUse> lobes = distribution.lobes;
  std::sort(lobes.begin(), lobes.end(), [](const LobeUse& a, const LobeUse& b) {
    return std::tie(a.alphaX, a.alphaY, a.f0, a.f90) < std::tie(b.alphaX, b.alphaY, b.f0, b.f90);
  });
  std::vector<double> below;
  double total = 0.0;
  for (const LobeUse& lobe : lobes) {
    total += lobe.weight;
    below.push_back(total);
  }

  const R2Sequence views(seed);
  const double shift = Random(mixSeed(seed, 1)).uniform();
  const AxisMap map = distribution.isotropic ? AxisMap::kSqrtOneMinusCos : AxisMap::kLinear;
  const double low = mapCoordinate(map, distribution.views.low);
  const double high = mapCoordinate(map, distribution.views.high);
  std::vector<LookUp> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    // lobes and theta, which errors depend on most, by R2, which is even in two dimensions
    const Eigen::Vector2d r2 = views(i);
    const double u = shift + static_cast<double>(i + 1) * (std::numbers::phi - 1.0);
    const double quantile = r2.y() * total;
    const auto at = std::min<std::size_t>(
        static_cast<std::size_t>(std::upper_bound(below.begin(), below.end(), quantile) - below.begin()),
        lobes.size() - 1);
    LobeParameters& p = out[i].parameters;
    p.alphaX = std::max(lobes[at].alphaX, alphaFloor);
    p.alphaY = std::max(lobes[at].alphaY, alphaFloor);
    p.theta = std::min(unmapCoordinate(map, low + r2.x() * (high - low)), 0.5 * std::numbers::pi);
    p.phi = distribution.isotropic ? 0.0 : (u - std::floor(u)) * 0.5 * std::numbers::pi;
    out[i].f0 = lobes[at].f0;
    out[i].f90 = lobes[at].f90;
  }
  return out;
}

}  // namespace ltcfit
