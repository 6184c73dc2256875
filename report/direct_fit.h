// Fits of single lobes by the same rules as a table was fitted: what the interpolation ratio divides by.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "fit/fit_provenance.h"
#include "fit/isotropic_table_fit.h"
#include "ltc/table.h"
#include "report/metrics.h"

namespace ltcfit {

/// At a node of a fitted table its fit is the node's entry, but for what rounding and later changes of the
/// table (refinement, storage in halves, interpolation at other nodes) did to it. The recipe is the one that
/// the provenance keeps: fitFromProvenance.
class DirectFit {
 public:
  /// For an isotropic "l3" table the whole table is fitted anew here, on `threads` threads (0: as many as
  /// OpenMP offers): its entries start from each other. Keeps a reference to `table`.
  DirectFit(const Table& table, int threads);

  /// The matrix, rounded as the table stores it; none where the fit has no inverse. `fetched` is where the
  /// fit begins for an isotropic table that names no fitter. Safe to call from several threads.
  std::optional<Eigen::Matrix3d> operator()(const LobeParameters& parameters, const Lobe& lobe,
                                            const LobeMoments& moments, const Eigen::Matrix3d& fetched) const;

  /// What the table's provenance says that was not done, and what was done instead.
  const std::vector<std::string>& notes() const { return recorded_.notes; }

 private:
  const Table& table_;
  RecordedFit recorded_;
  std::optional<IsotropicFitResult> chain_;  ///< the isotropic "l3" table
};

}  // namespace ltcfit
