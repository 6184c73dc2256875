// The stiff and extreme lobes that the fitters are tried on.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ltc/table.h"

namespace ltcfit {

/// A grid of lobes: all combinations of these, each once.
struct StabilitySet {
  std::string name;
  std::vector<double> alpha;   ///< alpha_x, in [1e-5, 1]
  std::vector<double> lambda;  ///< alpha_y / alpha_x, in (0, 1]
  std::vector<double> thetaDegrees;
  std::vector<double> phiDegrees;
  double alphaFloor = 1e-5;  ///< alpha_y is no smaller; in [1e-5, 1]
};

/// Reads data/stability_set.json or a file like it. Throws Refusal naming the field: not JSON,
/// another format, a list that is empty, of more than 64 numbers, or with one out of range.
StabilitySet parseStabilitySet(std::string_view json);

/// data/stability_set.json as it was when the program was built.
StabilitySet defaultStabilitySet();

/// The lobes, angles in radians; phi = 0 alone where it changes nothing (lambda = 1, theta = 0). Lobes that
/// the floor makes equal come once.
std::vector<LobeParameters> lobesOf(const StabilitySet& set);

}  // namespace ltcfit
