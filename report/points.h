// The sets of parameters at which tables are judged.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "ltc/table.h"

namespace ltcfit {

enum class PointSet {
  kNodes,    ///< the table's own nodes
  kOffGrid,  ///< random in the table's domain, fetched as a shader does
  kExtreme,  ///< random, sharp and grazing
};
/// "nodes", "off-grid" or "extreme", and back (Refusal).
std::string_view pointSetName(PointSet set);
PointSet pointSetFromName(std::string_view name);

struct Point {
  LobeParameters parameters;
  std::optional<std::size_t> node;  ///< number of the node, for kNodes
};

/// Points of a set for a table.
/// kNodes: `count` nodes drawn without repetition, all for 0 or more than there are; nodes with alpha_x below
/// `minAlpha` are left out.
/// kOffGrid, isotropic: sqrt(alpha) uniform in [0.05, 1], sqrt(1 - cos theta) in [0, 1]; anisotropic: alpha
/// in [0.03, 1], lambda in [0.05, 1], theta and phi in [0, pi/2]. kExtreme, isotropic: [0.01, 0.21] and
/// [0.97, 1]; anisotropic: lambda in [0.02, 0.2], theta in [0.85, 1] pi/2, the others as before. Of a table
/// whose axes do not go so far (reachOf), the parts of these intervals that they reach, or the end next to
/// them. `count` must be greater than 0 for both, alpha below minAlpha is left out.
std::vector<Point> makePoints(const Table& table, PointSet set, std::size_t count, double minAlpha,
                              std::uint64_t seed);

}  // namespace ltcfit
