// What else the numbers of a table could mean: other axes, another matrix, another order of its components.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "ltc/table.h"

namespace ltcfit {

/// What belongs to the nodes: axes in the order of the data, slowest first, named by what they are taken for.
/// Values may decrease; of an anisotropic table the first two may be alpha_x and alpha_y.
struct Arrangement {
  std::string name;  ///< as in "read with ..": "axes exchanged"; empty for the table's own
  int changes = 0;   ///< how many ways it differs from the table's own
  std::vector<Axis> axes;
};
/// All that are tried, the table's own first.
std::vector<Arrangement> arrangementsOf(const Table& table);
/// The lobe of a node, whose alphas are at least `floor`.
LobeParameters parametersOf(const Arrangement& arrangement, const std::vector<std::size_t>& node,
                            double floor);

/// How M follows from the nine numbers of a node.
struct MatrixReading {
  std::string name;
  int changes = 0;
  std::function<Eigen::Matrix3d(const TableEntry& entry)> m;  ///< not finite where there is no inverse
};
std::vector<MatrixReading> matrixReadingsOf(const Table& table);

}  // namespace ltcfit
