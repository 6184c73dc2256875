#include "ltc/axis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/refusal.h"

namespace ltcfit {

double mapCoordinate(AxisMap map, double v) {
  switch (map) {
    case AxisMap::kSqrt:
      return std::sqrt(v);
    case AxisMap::kSqrtOneMinusCos:
      return std::numbers::sqrt2 * std::sin(0.5 * v);  // sqrt(1 - cos v) without its cancellation
    case AxisMap::kNone:
    case AxisMap::kLinear:
      break;
  }
  return v;
}

double unmapCoordinate(AxisMap map, double u) {
  switch (map) {
    case AxisMap::kSqrt:
      return u * u;
    case AxisMap::kSqrtOneMinusCos:
      if (u >= 1.0 && u <= 1.0 + 1e-12) return 0.5 * std::numbers::pi;
      return 2.0 * std::asin(std::min(1.0, u / std::numbers::sqrt2));
    case AxisMap::kNone:
    case AxisMap::kLinear:
      break;
  }
  return u;
}

std::string_view axisMapName(AxisMap map) {
  switch (map) {
    case AxisMap::kLinear:
      return "linear";
    case AxisMap::kSqrt:
      return "sqrt";
    case AxisMap::kSqrtOneMinusCos:
      return "sqrt-one-minus-cos";
    case AxisMap::kNone:
      break;
  }
  return "";
}

AxisMap axisMapFromName(std::string_view name) {
  for (AxisMap map : {AxisMap::kLinear, AxisMap::kSqrt, AxisMap::kSqrtOneMinusCos}) {
    if (axisMapName(map) == name) return map;
  }
  throw Refusal("unknown axis map '" + std::string(name) + "' (linear, sqrt or sqrt-one-minus-cos)");
}

double leastDensity(const AxisWarp& warp) {
  const auto [a, b] = warp;
  if (!std::isfinite(a) || !std::isfinite(b)) return std::nan("");
  // the parabola 1 + a x + b (3 x^2 - 1) / 2 over [-1, 1]: least at an end, or where it turns
  if (b > 0.0 && std::abs(a) < 3.0 * b) return 1.0 - 0.5 * b - a * a / (6.0 * b);
  return 1.0 - std::abs(a) + b;
}

bool isMonotone(const AxisWarp& warp) {
  return leastDensity(warp) >= kLeastWarpDensity - 1e-9;  // false for NaN
}

double warpCoordinate(const AxisWarp& warp, double s) {
  return s + s * (1.0 - s) * (warp[0] + warp[1] * (1.0 - 2.0 * s));
}

double unwarpCoordinate(const AxisWarp& warp, double t) {
  if (warp == AxisWarp{} || t <= 0.0 || t >= 1.0) return t;
  // Newton's steps, kept between bounds by bisection
  double low = 0.0;
  double high = 1.0;
  double s = t;
  for (int i = 0; i < 60; ++i) {
    const double error = warpCoordinate(warp, s) - t;
    if (error == 0.0) break;
    (error < 0.0 ? low : high) = s;
    const double x = 1.0 - 2.0 * s;
    const double density = 1.0 + warp[0] * x + warp[1] * (1.5 * x * x - 0.5);
    double next = s - error / density;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == s) break;
    s = next;
  }
  return s;
}

double Axis::texelFromValue(double value) const {
  const double last = static_cast<double>(size() - 1);
  if (size() == 1) return 0.0;
  if (map == AxisMap::kNone) {
    const auto above = std::upper_bound(values.begin(), values.end(), value);
    if (above == values.begin()) return 0.0;
    if (above == values.end()) return last;
    const double lower = *(above - 1);
    return static_cast<double>(above - values.begin() - 1) + (value - lower) / (*above - lower);
  }
  const double u0 = mapCoordinate(map, low);
  const double u1 = mapCoordinate(map, high);
  const double even = (mapCoordinate(map, std::clamp(value, low, high)) - u0) / (u1 - u0);
  return std::clamp(warpCoordinate(warp, even) * last, 0.0, last);
}

bool Axis::spans(AxisMap mapping, double upTo) const {
  // float32 angles, as files hold them
  constexpr double kRounding = 1e-6;
  return size() > 1 && warp == AxisWarp{} && map == mapping && std::abs(low) < kRounding &&
         std::abs(high - upTo) < kRounding;
}

double Axis::valueFromTexel(double t) const {
  const double last = static_cast<double>(size() - 1);
  if (size() == 1) return values[0];
  if (map == AxisMap::kNone) {
    const std::size_t i = std::min(static_cast<std::size_t>(t), size() - 2);
    const double f = t - static_cast<double>(i);
    return values[i] * (1.0 - f) + values[i + 1] * f;
  }
  if (t >= last) return high;
  const double u0 = mapCoordinate(map, low);
  return unmapCoordinate(map, u0 + unwarpCoordinate(warp, t / last) * (mapCoordinate(map, high) - u0));
}

Axis makeAxis(std::string name, std::string unit, AxisMap map, std::size_t n, double low, double high,
              double floor, const AxisWarp& warp) {
  Axis axis{std::move(name), std::move(unit), {}, map, low, high, warp};
  axis.values.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    axis.values[i] = std::max(floor, axis.valueFromTexel(static_cast<double>(i)));
    if (i > 0 && !(axis.values[i] > axis.values[i - 1])) {
      throw Refusal("axis '" + axis.name + "': a floor of " + std::to_string(floor) +
                    " makes nodes coincide: lower it or use fewer nodes");
    }
  }
  return axis;
}

Axis singleNodeAxis(std::string name, std::string unit, double value) {
  return {std::move(name), std::move(unit), {value}, AxisMap::kNone, value, value, {}};
}

}  // namespace ltcfit
