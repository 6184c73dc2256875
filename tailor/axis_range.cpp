#include "tailor/axis_range.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "fit/table_plan.h"

namespace ltcfit {
namespace {

struct Extent {
  double low = 1.0;
  double high = 0.0;

  // up to the rounding of means of equal numbers
  bool isSingle() const { return high - low <= 1e-9 * high; }
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

AxisRange alphaRange(const Extent& extent, AxisMap map, double floor, double margin) {
  AxisRange range{"alpha", "1", map, extent.low, extent.high};
  if (extent.isSingle()) range.high = range.low;
  if (range.isSingle()) return range;
  const auto moved = [&](double alpha, double by) {
    const double roughness = std::sqrt(alpha) + by;
    return std::clamp(roughness * std::abs(roughness), floor, 1.0);
  };
  range.low = moved(extent.low, -margin);
  range.high = moved(extent.high, margin);
  return range;
}

}  // namespace

Axis AxisRange::axis(std::size_t nodes, const AxisWarp& warp) const {
  if (nodes > 1) return makeAxis(name, unit, map, nodes, low, high, 0.0, warp);
  const double middle = unmapCoordinate(map, 0.5 * (mapCoordinate(map, low) + mapCoordinate(map, high)));
  return singleNodeAxis(name, unit, isSingle() ? low : std::clamp(middle, low, high));
}

std::vector<AxisRange> axisRanges(const LobeDistribution& distribution, double alphaFloor, double margin) {
  Extent alpha;
  Extent lambda;
  for (const LobeUse& lobe : distribution.lobes) {
    const double larger = std::max(lobe.alphaX, alphaFloor);
    alpha.add(larger);
    lambda.add(std::max(lobe.alphaY, alphaFloor) / larger);
  }
  const ViewUse& views = distribution.views;
  const double high = std::min(views.high, kHalfPi);
  if (distribution.isotropic) {
    return {{"theta", "rad", AxisMap::kSqrtOneMinusCos, views.low, high},
            alphaRange(alpha, AxisMap::kSqrt, alphaFloor, margin)};
  }
  AxisRange ratio{"lambda", "1", AxisMap::kLinear, lambda.low, lambda.high};
  if (lambda.isSingle()) ratio.high = ratio.low;
  if (!ratio.isSingle()) {
    ratio.low = std::max(0.0, lambda.low - margin);
    ratio.high = std::min(1.0, lambda.high + margin);
  }
  return {alphaRange(alpha, AxisMap::kLinear, alphaFloor, margin),
          ratio,
          {"theta", "rad", AxisMap::kLinear, views.low, high},
          {"phi", "rad", AxisMap::kLinear, 0.0, kHalfPi}};
}

std::vector<Axis> fullAxes(bool isotropic, double alphaFloor) {
  if (isotropic) {
    IsotropicTableOptions options;
    options.alphaFloor = alphaFloor;
    return planIsotropicTable(options).info.axes;
  }
  AnisotropicTableOptions options;
  options.alphaFloor = alphaFloor;
  return planAnisotropicTable(options, SymmetryMode::kDuring).info.axes;
}

}  // namespace ltcfit
