// One lobe of a table under joint refinement: its matrix as a function of parameters that keep it usable.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/matrix_family.h"
#include "ltc/table.h"

namespace ltcfit {

/// What a table stores of a matrix: M or its inverse, scaled as told; kNone: of any scale.
struct StoredForm {
  MatrixStorage stores = MatrixStorage::kM;
  MatrixNormalization normalization = MatrixNormalization::kNone;
};

/// M L D U, L and U triangular with ones on the diagonal, D = s diag(x, y, 1) with s, x, y > 0 whatever the
/// parameters: det > 0, and the lobe's symmetry is kept (only entries that the family leaves). Unlike a fit
/// of one lobe, which leaves out the rotation about z on the right and the scale, these change: lobes do not
/// depend on them, but what lies between does. The scale is free where the form's normalization is kNone.
class RefinedEntry {
 public:
  /// `m`: of the family, det > 0. Parameters are 0 there, of order 1 for changes of the lobe's own size.
  RefinedEntry(const Eigen::Matrix3d& m, MatrixFamily family, StoredForm form);

  std::vector<double>& parameters() { return parameters_; }
  const std::vector<double>& parameters() const { return parameters_; }
  std::size_t size() const { return parameters_.size(); }
  MatrixFamily family() const { return family_; }

  /// To be called when the parameters have changed: makes the following.
  void update();
  const Eigen::Matrix3d& stored() const { return stored_; }
  /// d stored / d parameter k.
  const Eigen::Matrix3d& derivative(std::size_t k) const { return derivatives_[k]; }

  /// What a parameter moves.
  struct Change {
    enum class Factor { kLower, kDiagonal, kUpper, kScale } factor;
    int row;
    int column;  ///< kDiagonal: another element that goes with (row, row), or the same
  };

 private:
  Eigen::Matrix3d base_;
  MatrixFamily family_;
  StoredForm form_;
  std::vector<Change> changes_;
  std::vector<double> parameters_;
  Eigen::Matrix3d stored_;
  std::vector<Eigen::Matrix3d> derivatives_;
};

}  // namespace ltcfit
