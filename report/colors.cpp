#include "report/colors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace ltcfit {
namespace {

// The stops of report/page/colors.js, whose legends explain the pictures.
constexpr std::array<Rgb, 9> kDensity{{{68, 1, 84},
                                       {71, 45, 123},
                                       {59, 82, 139},
                                       {44, 114, 142},
                                       {33, 145, 140},
                                       {40, 174, 128},
                                       {94, 201, 98},
                                       {173, 220, 48},
                                       {253, 231, 37}}};
constexpr std::array<Rgb, 5> kDifference{
    {{27, 79, 156}, {127, 173, 217}, {242, 242, 240}, {242, 166, 90}, {179, 71, 0}}};

template <std::size_t N>
Rgb interpolated(const std::array<Rgb, N>& colors, double t) {
  // not std::clamp: NaN becomes the lowest colour
  const double x = std::fmin(std::fmax(t, 0.0), 1.0) * static_cast<double>(N - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), N - 2);
  const double f = x - static_cast<double>(i);
  Rgb out{};
  for (std::size_t c = 0; c < out.size(); ++c)
    out[c] = static_cast<std::uint8_t>(std::lround((1.0 - f) * colors[i][c] + f * colors[i + 1][c]));
  return out;
}

}  // namespace

Rgb densityColor(double t) {
  return interpolated(kDensity, t);
}

Rgb differenceColor(double t) {
  return interpolated(kDifference, 0.5 * (t + 1.0));
}

}  // namespace ltcfit
