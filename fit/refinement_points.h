// The look-ups that joint refinement fits a table for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fit/table_plan.h"
#include "ltc/table.h"

namespace ltcfit {

struct RefinementPoint {
  LobeParameters parameters;
  double weight = 1.0;
  bool isNode = false;
  std::size_t node = 0;  ///< its number
};

/// `count` points over the axes of a table that are spread evenly (an additive recurrence in as many
/// dimensions as there are axes), whatever the placement of its nodes: in alpha, lambda, theta and phi, in
/// sqrt(alpha) and sqrt(1 - cos theta) for isotropic tables. With `crowded` more of less weight at sharp
/// lobes and grazing view, where lobes change fastest.
std::vector<RefinementPoint> refinementPoints(const TableInfo& info, std::size_t count, std::uint64_t seed,
                                              bool crowded);

}  // namespace ltcfit
