// Fits the matrix of one table entry with Nelder-Mead on the L3 error.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "fit/isotropic_family.h"
#include "fit/matrix_family.h"
#include "fit/nelder_mead.h"
#include "ggx/lobe.h"
#include "ggx/moments.h"

namespace ltcfit {

struct EntryFitOptions {
  IsotropicFamily family = IsotropicFamily::kPlane4;
  /// Directions of the lobe, and as many of the LTC, for the objective.
  int samples = 1024;
  std::uint64_t seed = 1;
  NelderMeadOptions nelderMead;
  /// Edge of the first simplex, in the scaled parameters of IsotropicParametrization.
  double simplexEdge = 0.1;

  /// False with a message naming the option, its value and its range.
  bool isValid(std::string* error) const;
};

/// Result of one fit.
struct EntryFit {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();  ///< in the shading frame, det > 0, any scale
  double startCost = 0.0;                           ///< 2016 objective at the start
  double cost = 0.0;                                ///< and at the end, by the fit's own samples
  double relativeL3 = 0.0;  ///< (cost / integral |rho cos|^3)^(1/3): 0 perfect, 1 as bad as no light at all
  int evaluations = 0;
  Termination termination = Termination::kFailure;
};

/// Minimises the L3 objective from `start`. `moments` are those of `lobe`, whose wo lies in the x-z plane.
EntryFit fitIsotropicEntry(const Lobe& lobe, const LobeMoments& moments, const Eigen::Matrix3d& start,
                           const EntryFitOptions& options);

/// The same objective over the matrices of a family, from `start` in that family: what the 2022 paper
/// compares with. The simplex moves in P of M (I + P). `albedo` is the lobe's n_D; options.family is not
/// used.
EntryFit fitL3Entry(const Lobe& lobe, double albedo, MatrixFamily family, const Eigen::Matrix3d& start,
                    const EntryFitOptions& options);

}  // namespace ltcfit
