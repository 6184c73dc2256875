// Which lobes of a table are worth a picture.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ltc/table.h"
#include "report/score.h"

namespace ltcfit {

struct ChosenLobe {
  std::size_t node = 0;
  std::string why;  ///< "largest SW1rel"
};

/// Alphas from which on errors are looked for: of sharper lobes at grazing view pictures show a few pixels.
inline constexpr double kSharpestPicture = 0.01;

/// Up to eight nodes of different parameters: the least, median and largest SW1rel, the largest light_m and
/// the most light below the horizon among those with both alphas from kSharpestPicture on, and those nearest
/// to a sharp lobe at grazing view, a rough one at normal view and a medium one. `nodes` is the table's score
/// at all of its nodes, in order. Nodes without an inverse are passed over.
std::vector<ChosenLobe> chooseLobes(const Table& table, const Score& nodes);

}  // namespace ltcfit
