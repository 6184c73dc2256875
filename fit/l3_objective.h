// The L3 objective of Heitz et al. 2016 by multiple importance sampling.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ggx/lobe.h"

namespace ltcfit {

/// cost(M) = integral over the sphere of |rho cos - n_D f_M|^3, with f_M the LTC of M (Heitz et al. 2016,
/// section 4: "minimizing the L3 error"). Estimated from n directions of the lobe and n of the LTC with the
/// balance heuristic; the points are fixed by the seed, so that the cost is a smooth, deterministic function
/// of M.
///
/// The lobe's own directions, with their eval and pdf, are drawn once. Those of the LTC are M times fixed
/// cosine samples, so that f_M there needs no inverse.
class L3Objective {
 public:
  /// `albedo` n_D > 0 of the lobe; `samples` >= 1 directions of each of the two kinds. Keeps a reference to
  /// `lobe`.
  L3Objective(const Lobe& lobe, double albedo, int samples, std::uint64_t seed);

  /// The cost, in sr^-2; scales like alpha^-4 for sharp lobes. +infinity for a singular or non-finite matrix.
  /// Thread-safe: calls share nothing.
  double operator()(const Eigen::Matrix3d& m) const;

  /// integral of |rho cos|^3 by the lobe's samples: cost / lobeCube() is free of the lobe's scale, 1 for a
  /// model that is 0 everywhere.
  double lobeCube() const { return lobeCube_; }

 private:
  const Lobe& lobe_;
  double albedo_;
  double lobeCube_ = 0.0;
  // lobe samples, structure of arrays
  std::vector<double> lobeX_, lobeY_, lobeZ_, lobeEval_, lobePdf_;
  // cosine samples
  std::vector<double> cosX_, cosY_, cosZ_;
};

}  // namespace ltcfit
