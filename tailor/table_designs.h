// Sizes and node placements of a table, by the error that they are predicted to cost.
#pragma once

#include <cstddef>
#include <vector>

#include "tailor/interpolation_model.h"

namespace ltcfit {

/// Numbers of nodes, one for each axis.
struct TableDesign {
  std::vector<std::size_t> nodes;
  double error = 0.0;  ///< InterpolationModel::error

  std::size_t nodeCount() const;
};

/// All numbers of nodes up to a largest one, each axis with the warp that suits it best.
class TableDesigns {
 public:
  /// Largest numbers of nodes that are looked at, along each axis.
  static constexpr std::size_t kLargestIsotropic = 64;
  static constexpr std::size_t kLargestAnisotropic = 16;

  explicit TableDesigns(const InterpolationModel& model);

  /// Designs that none is both smaller and better than, with increasing numbers of nodes; never empty. The
  /// first one has a single node.
  const std::vector<TableDesign>& front() const { return front_; }
  /// Any design of at least one node along each axis, and at most the largest number.
  TableDesign design(std::vector<std::size_t> nodes) const;
  std::vector<Axis> axes(const TableDesign& design) const;
  /// The largest number of nodes along an axis.
  std::size_t largest(std::size_t axis) const { return choices_[axis].size(); }

 private:
  struct Choice {  // of one axis, for one number of nodes
    Axis axis;
    InterpolationModel::Shifts shifts;
  };
  double error(const std::vector<std::size_t>& nodes) const;

  const InterpolationModel& model_;
  std::vector<std::vector<Choice>> choices_;  // for each axis; one node first
  std::vector<TableDesign> front_;
};

}  // namespace ltcfit
