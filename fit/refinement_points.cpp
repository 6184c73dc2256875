#include "fit/refinement_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ggx/random.h"

namespace ltcfit {
namespace {

// How points crowd along an axis: at its low end as u^(1 + exponent), or at its high end.
struct Crowding {
  AxisMap measure;  // in which points are even
  double exponent;
  bool high;
};
constexpr std::array<Crowding, 2> kIsotropic{
    {{AxisMap::kSqrtOneMinusCos, 0.8, true}, {AxisMap::kSqrt, 0.8, false}}};
constexpr std::array<Crowding, 4> kAnisotropic{{{AxisMap::kLinear, 0.8, false},
                                                {AxisMap::kLinear, 0.6, false},
                                                {AxisMap::kLinear, 0.8, true},
                                                {AxisMap::kLinear, 0.0, false}}};

// The root of x^(d + 1) = x + 1: golden ratio, plastic number, and so on.
double harmoniousNumber(std::size_t dimensions) {
  double x = 1.5;
  for (int i = 0; i < 64; ++i) x = std::pow(1.0 + x, 1.0 / static_cast<double>(dimensions + 1));
  return x;
}

}  // namespace

std::vector<RefinementPoint> refinementPoints(const TableInfo& info, std::size_t count, std::uint64_t seed,
                                              bool crowded) {
  const std::size_t dims = info.axes.size();
  const bool isotropic = dims == 2;
  Random random(seed);
  std::array<double, 4> shift{};
  for (double& s : shift) s = random.uniform();
  const double g = harmoniousNumber(dims);

  std::vector<RefinementPoint> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    RefinementPoint point;
    std::array<double, 4> value{};
    double step = 1.0;
    for (std::size_t a = 0; a < dims; ++a) {
      const Crowding& c = isotropic ? kIsotropic[a] : kAnisotropic[a];
      const Axis& axis = info.axes[a];
      step /= g;
      double u = std::fmod(shift[a] + static_cast<double>(i + 1) * step, 1.0);
      if (crowded && c.exponent > 0.0 && axis.size() > 1) {
        const double v = c.high ? 1.0 - u : u;
        point.weight *= (1.0 + c.exponent) * std::pow(v, c.exponent);
        u = std::pow(v, 1.0 + c.exponent);
        if (c.high) u = 1.0 - u;
      }
      const double low = mapCoordinate(c.measure, axis.values.front());
      const double high = mapCoordinate(c.measure, axis.values.back());
      value[a] = std::clamp(unmapCoordinate(c.measure, low + u * (high - low)), axis.values.front(),
                            axis.values.back());
    }
    if (isotropic) {
      const double alpha = std::max(value[1], info.alphaFloor);
      point.parameters = {alpha, alpha, value[0], 0.0};
    } else {
      const double alpha = std::max(value[0], info.alphaFloor);
      point.parameters = {alpha, std::max(alpha * value[1], info.alphaFloor), value[2], value[3]};
    }
    out.push_back(point);
  }
  return out;
}

}  // namespace ltcfit
