// Where the nodes of a fitted table lie along its axes.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "ltc/axis.h"

namespace ltcfit {

/// How the nodes of one axis lie over its full range, 0 to 1 or to pi/2: evenly in `map`, crowded as `warp`
/// says; or, with AxisMap::kNone, at `knots`, which a shader would have to search.
struct NodePlacement {
  AxisMap map = AxisMap::kLinear;
  AxisWarp warp{};
  std::vector<double> knots{};  ///< physical coordinates of all nodes, both ends of the range included

  bool operator==(const NodePlacement&) const = default;
};

using IsotropicPlacement = std::array<NodePlacement, 2>;    ///< theta, alpha
using AnisotropicPlacement = std::array<NodePlacement, 4>;  ///< alpha, lambda, theta, phi

inline constexpr std::array<std::string_view, 2> kIsotropicAxisNames{"theta", "alpha"};
inline constexpr std::array<std::string_view, 4> kAnisotropicAxisNames{"alpha", "lambda", "theta", "phi"};

/// "2017": sqrt(1 - cos theta), as engines read it, the default; "2016": theta, linear, as Heitz et al. 2016
/// print it; both with the root of alpha. "best": of least measured error, warped.
/// Another name throws Refusal.
IsotropicPlacement isotropicPlacement(std::string_view name);

/// "2022": all axes linear, as KT et al. 2022 have them, the default; "best": of least measured error.
AnisotropicPlacement anisotropicPlacement(std::string_view name);

/// The axis `name` (of those above) with n >= 2 nodes, values clamped from below to `floor`. Throws
/// Refusal, with a message that begins with the option --axes and the axis, for a warp that is
/// not monotone, a map that no table may have on this axis (Table), and knots that are not n, do not increase
/// or do not reach from end to end.
Axis placedAxis(std::string_view name, const NodePlacement& placement, std::size_t n, double floor = 0.0);

}  // namespace ltcfit
