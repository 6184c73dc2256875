// All matrices of a table rounded to half precision.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ltc/table.h"

namespace ltcfit {

/// What rounding to halves did to one node.
struct HalfNode {
  std::size_t node = 0;
  double shift = 0.0;  ///< of the lobe's directions, radians (export/half_matrix.h)
  double detError = 0.0;
  bool constrained = false;                     ///< the nearest halves would have broken a bound
  bool moved = false;                           ///< some entry is not the half nearest to it
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();  ///< M of the rounded matrix, up to its scale
};

struct HalfReport {
  std::size_t moved = 0;        ///< nodes with an entry that is not the nearest half
  std::size_t constrained = 0;  ///< nodes whose nearest halves would have broken a bound
  std::size_t beyond = 0;       ///< nodes whose determinant halves cannot keep within 1 %
  double alphaFloor =
      0.0;  ///< from this alpha_y (the smaller one) on, every determinant is within 1 %; infinite for none
  double largestShift = 0.0;     ///< at nodes, and beside those that were bounded
  double largestDetError = 0.0;  ///< over the nodes from alphaFloor on
  std::vector<HalfNode> nodes;   ///< all, in the order of the table; empty for floats
};

/// "the node at alpha .., theta .. degrees": for messages.
std::string placeOf(const Table& table, std::size_t node);

/// What a user should know before shipping these halves: nothing for tables whose lobes move by less than
/// 0.05 radians.
std::optional<std::string> warningOf(const HalfReport& report);

/// The smallest power of two that lifts every diagonal entry out of the subnormal halves, as far as the
/// largest entries permit.
double halfScale(const std::vector<Eigen::Matrix3d>& matrices);

/// Rounds the `free` entries of scale * matrices to halves (roundToHalf), in place: one matrix for each node
/// of the table, M or its inverse as `stores` says. Equal matrices are rounded once, in parallel; the result
/// does not depend on threads. Throws Refusal naming the node's alpha and theta.
HalfReport roundMatrices(const Table& table, std::vector<Eigen::Matrix3d>& matrices, MatrixStorage stores,
                         const std::array<bool, 9>& free, double scale);

}  // namespace ltcfit
