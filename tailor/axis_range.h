// Where along each axis a scene looks its table up.
#pragma once

#include <string>
#include <vector>

#include "ltc/axis.h"
#include "tailor/lobe_distribution.h"

namespace ltcfit {

/// The part of one axis that a table covers; low = high: a single value occurs.
struct AxisRange {
  std::string name;  ///< as in Axis
  std::string unit;
  AxisMap map = AxisMap::kLinear;
  double low = 0.0;
  double high = 0.0;

  bool isSingle() const { return low == high; }
  /// The axis of `nodes` nodes over it; one node sits in the middle, in the map's coordinate.
  Axis axis(std::size_t nodes, const AxisWarp& warp = {}) const;
};

/// The ranges of a distribution's table, in the order of its axes. Alphas count as no smaller than
/// `alphaFloor`. A parameter that varies gets a margin on both sides within its domain: `margin` in roughness
/// (the root of alpha) and in lambda. Angles cover the scene's views, phi the whole quadrant.
std::vector<AxisRange> axisRanges(const LobeDistribution& distribution, double alphaFloor, double margin);

/// The axes of the table that serves every scene, which a tailored one is compared with: 64 x 64 over
/// sqrt(1 - cos theta) and the root of alpha, or 8 x 8 x 8 x 8.
std::vector<Axis> fullAxes(bool isotropic, double alphaFloor);

}  // namespace ltcfit
