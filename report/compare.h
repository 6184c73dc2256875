// How two tables differ: as numbers and as lobes, without a look at what they stand for.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "ltc/table.h"
#include "report/statistics.h"

namespace ltcfit {

struct ChannelDifference {
  std::string channel;
  std::size_t different = 0;  ///< nodes at which the float32 values differ
  double largest = 0.0;       ///< absolute
};

struct TableDifference {
  bool sameNodes = false;    ///< the axes have the same nodes: the second table was not interpolated
  bool sameStorage = false;  ///< and both store the same channels of the same matrix, scaled alike
  std::vector<ChannelDifference> channels;  ///< where sameStorage
  Summary sw1;      ///< over the first table's nodes: distance between the two lobes, 0..2
  Summary between;  ///< the same in the middle of the first table's cells, both fetched
  Summary norm;     ///< |difference|; count 0 where a table has no such channel
  Summary fresnel;
  std::vector<std::string> oneSided;  ///< norm or fresnel, where only one of the two tables has it
  std::size_t singular = 0;           ///< nodes at which one of the two has no inverse: in no summary
  std::size_t worstNode = 0;          ///< of sw1, in the first table
};

/// The sliced Wasserstein distance between the LTCs of two matrices with det != 0, 0..2: 256 directions of
/// each, 16 projections, the same for both, so that equal lobes have distance 0 and the same lobe under
/// another matrix (turned about z from the right) a small one, at most 0.02 of its width.
double lobeDistance(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

/// Compares at the nodes of the first table and between them, lobes by lobeDistance(). Throws
/// Refusal where one is isotropic and the other anisotropic. Independent of threads.
TableDifference compareTables(const Table& first, const Table& second);

}  // namespace ltcfit
