// The axes of a table: where its nodes are, and how a shader finds them.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ltcfit {

/// How a shader turns a physical coordinate into the one in which the nodes are evenly spaced.
enum class AxisMap {
  kNone,             ///< nodes anywhere: the shader searches
  kLinear,           ///< u = v
  kSqrt,             ///< u = sqrt(v): roughness from alpha
  kSqrtOneMinusCos,  ///< u = sqrt(1 - cos v): the angle axis of the 2017 table
};

/// u of v, and v of u: an inverse pair for every map. Angles in radians. At u = 1 the angle of
/// kSqrtOneMinusCos is exactly pi/2.
double mapCoordinate(AxisMap map, double v);
double unmapCoordinate(AxisMap map, double u);

/// The name in the table file ("linear", "sqrt", "sqrt-one-minus-cos"; "" for kNone), and back. An unknown
/// name throws Refusal.
std::string_view axisMapName(AxisMap map);
AxisMap axisMapFromName(std::string_view name);

/// Where nodes crowd: coefficients (a, b) of t = s + s (1 - s) (a + b (1 - 2 s)), which takes [0, 1] to
/// itself. The density of nodes is dt/ds = 1 + a P1(x) + b P2(x), x = 1 - 2 s, with Legendre's polynomials: a
/// moves nodes to the low end, b to both ends. Zeros: even.
using AxisWarp = std::array<double, 2>;

/// The least density, as a part of the mean one, that a warp may have.
inline constexpr double kLeastWarpDensity = 0.05;

/// The least density anywhere, as a part of the mean one; NaN for coefficients that are not finite.
double leastDensity(const AxisWarp& warp);
/// Whether the coefficients are finite and the density is nowhere below kLeastWarpDensity, up to rounding.
bool isMonotone(const AxisWarp& warp);
/// t of s and s of t, both 0..1: an inverse pair for monotone warps.
double warpCoordinate(const AxisWarp& warp, double s);
double unwarpCoordinate(const AxisWarp& warp, double t);

/// One axis. Node i of n sits at texel i. Texel t belongs to the physical coordinate
/// unmap(map(low) + unwarp(t / (n - 1)) (map(high) - map(low))). A value may differ from its texel's
/// coordinate only at the ends, where the fit was clamped (alpha floor, grazing angle): the shader's formula
/// still holds. An axis of one node has no map: whatever is asked for, the node is the answer.
struct Axis {
  std::string name;            ///< theta, phi, alpha, lambda, alpha_x or alpha_y
  std::string unit;            ///< "rad" or "1"
  std::vector<double> values;  ///< physical coordinate at which each node was fitted, strictly increasing
  AxisMap map = AxisMap::kNone;
  double low = 0.0;   ///< physical coordinate of texel 0 (ignored for kNone)
  double high = 0.0;  ///< physical coordinate of texel n - 1
  AxisWarp warp{};    ///< zeros for kNone

  std::size_t size() const { return values.size(); }

  /// Whether its texels, two or more, are evenly spaced in `mapping` from 0 to `upTo`, up to rounding in a
  /// file.
  bool spans(AxisMap mapping, double upTo) const;

  /// Continuous texel coordinate of a physical one, clamped to [0, n - 1].
  double texelFromValue(double value) const;
  /// Its inverse, for t in [0, n - 1].
  double valueFromTexel(double t) const;
};

/// An axis of n >= 2 nodes, spaced in `map` from low to high as `warp` (monotone) says, values clamped from
/// below to `floor`. Throws Refusal where the floor would make two nodes coincide.
Axis makeAxis(std::string name, std::string unit, AxisMap map, std::size_t n, double low, double high,
              double floor = 0.0, const AxisWarp& warp = {});

/// An axis of one node.
Axis singleNodeAxis(std::string name, std::string unit, double value);

}  // namespace ltcfit
