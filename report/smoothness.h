// Whether a table moves between its nodes as the lobes do.
#pragma once

#include <cstddef>
#include <vector>

#include "ltc/table.h"
#include "report/statistics.h"

namespace ltcfit {

/// Along one axis, from every node to the next one.
struct AxisSmoothness {
  std::string axis;
  /// One for each node, in the order of the data: the step to the next node on this axis. NaN where there is
  /// no next node, infinite where a matrix of the step has no inverse.
  std::vector<double> steps;
  Summary summary;  ///< over the steps that there are; infinite ones count as non-finite
};

/// The excess of a step: how much farther the fetched lobe travels from a node over the lobe half way, which
/// is that of the mean of the two stored matrices, to the next node, than the true lobe does from node to
/// node; in units of the lobe's width, at least 0:
///   (d(A, H) + d(H, B) - d(a, b)) / width,
/// d the sliced Wasserstein distance (256 directions of each lobe, 16 projections), a and b the true lobes
/// at the two nodes, width the larger one of their spreads (as in SW1rel). At 0 the table moves no farther
/// than the lobe itself; a lobe that is off its neighbours, which pops as the view moves, makes a detour,
/// and so do matrices that are right at the nodes but do not interpolate (a column of the other sign).
/// Steps of a good table come out at a few hundredths, the noise of the directions, and where nodes lie far
/// apart at what the interpolated lobe is too wide. Independent of threads (0: as many as OpenMP offers).
std::vector<AxisSmoothness> tableSmoothness(const Table& table, int threads);

}  // namespace ltcfit
