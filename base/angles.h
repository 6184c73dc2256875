// Pi and degrees, once for all.
#pragma once

#include <numbers>

namespace ltcfit {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kHalfPi = 0.5 * std::numbers::pi;
inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

}  // namespace ltcfit
