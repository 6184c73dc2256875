// The sliced-Wasserstein distance between an LTC and a lobe as differences of projected CDFs: no sorting.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fit/lobe_samples.h"
#include "fit/matrix_family.h"

namespace ltcfit {

/// Slices for lobes of a family: directions spread evenly over what its mirror symmetry leaves of the sphere
/// (a direction and its opposite see the same).
std::vector<Eigen::Vector3d> familySlices(MatrixFamily family, int count);

/// loss(M) = mean over slices w of the integral over t of |F_w(t) - G_w(t)|, F_w and G_w the CDFs of the LTC
/// and of the lobe projected on w: the same number as the mean distance of sorted projections (KT et al.
/// 2022, eq. 9 and 10), since in one dimension both are the area between the CDFs.
///
/// Both CDFs are taken as means over small cells of t, which a sample changes continuously as it moves
/// through one; so the loss needs no sorting, and its gradient is that of the area between piecewise linear
/// curves. Cells are uniform in log2(1 + |t - centre| / scale), taken piecewise linearly from the bits of a
/// float, so that tails of any length are resolved in proportion. Within 0.5 % of
/// sorting the same samples.
///
/// Not thread-safe (it has scratch memory); one object for each entry.
class ProjectedCdfLoss {
 public:
  /// One slice and its cells, whose centre is the start's third column.
  struct Slice {
    float x, y, z;             ///< direction
    float scale;               ///< of the cells
    float inverse;             ///< 1 / scale
    int octaves;               ///< cells reach (2^octaves - 1) scale to both sides
    std::size_t at;            ///< first cell in targetCdf_
    std::int32_t first, last;  ///< cells that hold the lobe's samples
  };

  /// `target`: the lobe. `start`: a matrix of roughly its direction and widths, which sets centres and scales
  /// of the cells. `cosine`: directions of the clamped cosine, their weights in steps of 2^-25. `slices`:
  /// unit directions.
  ProjectedCdfLoss(const LobeSamples& target, const Eigen::Matrix3d& start, const LobeSamples& cosine,
                   const std::vector<Eigen::Vector3d>& slices);

  /// Loss of the LTC of `m`, in [0, 2], and, where asked for, its derivatives d loss / d m_rc.
  double operator()(const Eigen::Matrix3d& m, Eigen::Matrix3d* gradient);

 private:
  void addToHistogram(std::size_t n);
  double areaBetweenCdfs(const Slice& s, std::int32_t first, std::int32_t last);

  Eigen::Vector3d reference_;  // projections are relative to it: keeps float's digits for sharp lobes
  std::vector<double> cosX_, cosY_, cosZ_;
  std::vector<std::int32_t> weight_;  // of the cosine samples, in fixed point
  std::vector<Slice> slices_;
  std::vector<std::int64_t> targetCdf_;  // mean of G over each cell, all slices, in fixed point
  // scratch
  std::vector<float> x_, y_, z_;
  std::vector<double> invLength_;
  std::vector<float> gx_, gy_, gz_;
  std::vector<std::int32_t> cell_;
  std::vector<std::int32_t> part_;
  std::vector<std::uint64_t> histogram_;
  std::vector<float> sign_;
};

}  // namespace ltcfit
