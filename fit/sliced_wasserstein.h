// The sliced-Wasserstein loss of KT et al. 2022 as printed: samples, projections, sorting, and its gradient.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fit/sorted_projections.h"

namespace ltcfit {

/// L(M) = mean over slices w and ranks i of |f_(i),w - g_(i),w|, the sorted projections of the LTC's samples
/// f = M x / |M x| and of the lobe's samples g (KT et al. 2022, eq. 10 and Algorithm 3), in [0, 2].
/// With as many LTC samples as lobe samples, all equally likely. Double precision: the reference for
/// ProjectedCdfLoss, and what the stochastic descent steps on.
///
/// Not thread-safe (it has scratch memory).
class SlicedWasserstein {
 public:
  /// Sets the lobe's samples and the slices (unit vectors), and sorts the projections.
  void setTarget(std::span<const Eigen::Vector3d> lobe, std::span<const Eigen::Vector3d> slices);

  /// The loss for the LTC samples of `m` (any scale; det may be 0) made of `cosine`, as many directions of
  /// the clamped cosine as the lobe has samples: other counts are a caller's bug and abort. `gradient`, where
  /// asked for, gets d L / d m_rc: the derivative for the given ranks, which is exact but where two
  /// projections tie or a difference is 0 (there it is one of the one-sided ones).
  double evaluate(const Eigen::Matrix3d& m, std::span<const Eigen::Vector3d> cosine,
                  Eigen::Matrix3d* gradient);

 private:
  std::vector<Eigen::Vector3d> slices_;
  std::vector<double> target_;  // sorted projections, slice by slice
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  std::size_t samples_ = 0;
  // scratch
  ProjectionSorter sorter_;
  std::vector<double> projections_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<double> invLengths_;
  std::vector<Eigen::Vector3d> pull_;
};

}  // namespace ltcfit
