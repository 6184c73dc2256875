#include "fit/node_placement.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/angles.h"
#include "base/refusal.h"

namespace ltcfit {
namespace {

bool isAngle(std::string_view axis) {
  return axis == "theta" || axis == "phi";
}

[[noreturn]] void refuse(std::string_view axis, const std::string& what) {
  throw Refusal(fmt::format("--axes {}: {}", axis, what));
}

void checkKnots(std::string_view axis, const std::vector<double>& knots, std::size_t n) {
  if (knots.size() != n) refuse(axis, fmt::format("{} knots for {} nodes (--size)", knots.size(), n));
  for (std::size_t i = 1; i < n; ++i)
    if (!(knots[i] > knots[i - 1])) refuse(axis, fmt::format("knot {} does not increase", i + 1));
  if (knots.front() != 0.0 || knots.back() != (isAngle(axis) ? kHalfPi : 1.0))
    refuse(axis, fmt::format("the first knot must be 0, the last {}", isAngle(axis) ? "90 (degrees)" : "1"));
}

}  // namespace

IsotropicPlacement isotropicPlacement(std::string_view name) {
  const NodePlacement root{AxisMap::kSqrt};
  if (name == "2017") return {NodePlacement{AxisMap::kSqrtOneMinusCos}, root};
  if (name == "2016") return {NodePlacement{}, root};
  // From the warps that are predicted best at 56 to 72 nodes, as below, on towards what helps sharp lobes at
  // grazing views. Over 2017, both 64 x 64 and fitted by default, 400 points: off-grid nothing to speak of
  // (SW1 0.999 times, form 0.99), where interpolation costs next to nothing; extreme SW1 0.90, SW1rel 0.51,
  // form 0.47, light_m 0.75, interpolation ratio p90 11.8 to 3.4. At 32 x 32 extreme SW1 0.67, light_m 0.47.
  if (name == "best")
    return {NodePlacement{AxisMap::kSqrtOneMinusCos, {-0.6, 0.3}},
            NodePlacement{AxisMap::kSqrt, {0.5, -0.2}}};
  throw Refusal(fmt::format("unknown axes '{}' (2016, 2017 or best)", name));
}

AnisotropicPlacement anisotropicPlacement(std::string_view name) {
  if (name == "2022") return {};
  // Of the maps and warps for which direct fits along lines predict the least error at 7 to 9 nodes an axis
  // (InterpolationModel, 384 look-ups over the off-grid domain), the ones that do best once fitted. Over the
  // linear axes, both 8^4 and fitted by default, 400 points, off-grid and extreme: interpolation ratio p90
  // 1.37 to 1.29 and 1.82 to 1.53, p99 3.6 to 3.2 and 3.6 to 2.5; SW1 0.97 and 0.96 times, form 0.94 and
  // 0.89, light_m 0.93 and 0.92, its p99 0.70 and 0.92. The map of phi gains no accuracy, but costs no atan.
  if (name == "best")
    return {NodePlacement{AxisMap::kLinear, {0.5, 0.0}}, NodePlacement{AxisMap::kLinear, {0.2, 0.0}},
            NodePlacement{AxisMap::kLinear, {-0.35, 0.2}},
            NodePlacement{AxisMap::kSqrtOneMinusCos, {-0.2, 0.1}}};
  throw Refusal(fmt::format("unknown axes '{}' (2022 or best)", name));
}

Axis placedAxis(std::string_view name, const NodePlacement& placement, std::size_t n, double floor) {
  const bool angle = isAngle(name);
  const double high = angle ? kHalfPi : 1.0;
  const char* const unit = angle ? "rad" : "1";
  if (placement.map == AxisMap::kNone) {
    checkKnots(name, placement.knots, n);
    Axis axis{std::string(name), unit, placement.knots, AxisMap::kNone, 0.0, high, {}};
    axis.values.front() = std::max(floor, axis.values.front());
    return axis;
  }
  if (placement.map == (angle ? AxisMap::kSqrt : AxisMap::kSqrtOneMinusCos))
    refuse(name, fmt::format("{} is a map of {} (here: linear, {})", axisMapName(placement.map),
                             angle ? "alpha and lambda" : "angles",
                             axisMapName(angle ? AxisMap::kSqrtOneMinusCos : AxisMap::kSqrt)));
  if (!isMonotone(placement.warp))
    refuse(name, fmt::format("the warp {}:{} brings the density of nodes down to {:.3g} of its mean, need {} "
                             "or more (density 1 + A x + B (3 x^2 - 1) / 2, x from 1 to -1)",
                             placement.warp[0], placement.warp[1], leastDensity(placement.warp),
                             kLeastWarpDensity));
  return makeAxis(std::string(name), unit, placement.map, n, 0.0, high, floor, placement.warp);
}

}  // namespace ltcfit
