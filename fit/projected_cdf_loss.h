// The sliced-Wasserstein distance between an LTC and a lobe as differences of projected CDFs: no sorting.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fit/lobe_samples.h"
#include "fit/matrix_family.h"

namespace ltcfit {

/// Slices for lobes of a family: directions spread evenly over what its mirror symmetry leaves of the sphere
/// (a direction and its opposite see the same).
std::vector<Eigen::Vector3d> familySlices(MatrixFamily family, int count);

/// One slice of a lobe and its cells.
struct ProjectedSlice {
  float x, y, z;             ///< direction
  float scale;               ///< of the cells
  float inverse;             ///< 1 / scale
  int octaves;               ///< cells reach (2^octaves - 1) scale to both sides
  std::size_t at;            ///< first cell in ProjectedLobe::cdf
  std::int32_t first, last;  ///< cells that hold the lobe's samples
};

/// The CDFs of a lobe projected on slices, as means over small cells of t. Cells are uniform in
/// log2(1 + |t - centre| / scale), taken piecewise linearly from the bits of a float, so that tails of any
/// length are resolved in proportion.
struct ProjectedLobe {
  /// `start`: a matrix of roughly the direction and widths of the lobe, which sets centres (its third column)
  /// and scales of the cells. `slices`: unit directions.
  ProjectedLobe(const LobeSamples& target, const Eigen::Matrix3d& start,
                const std::vector<Eigen::Vector3d>& slices);

  Eigen::Vector3d reference;  ///< projections are relative to it: keeps float's digits for sharp lobes
  std::vector<ProjectedSlice> slices;
  std::vector<std::int64_t> cdf;  ///< mean over each cell, all slices, in fixed point
  std::size_t mostCells = 0;      ///< of one slice
};

/// loss(M) = mean over slices w of the integral over t of |F_w(t) - G_w(t)|, F_w and G_w the CDFs of the LTC
/// and of the lobe projected on w: the same number as the mean distance of sorted projections (KT et al.
/// 2022, eq. 9 and 10), since in one dimension both are the area between the CDFs.
///
/// Both CDFs are taken as means over cells, which a sample changes continuously as it moves through one; so
/// the loss needs no sorting, and its gradient is that of the area between piecewise linear curves. Within
/// 0.5 % of sorting the same samples.
///
/// Serves any number of lobes. Not thread-safe (it has scratch memory).
class ProjectedCosine {
 public:
  /// Derivatives by the entries of P, row by row, for the LTC of M (I + P) at P = 0.
  struct Derivatives {
    Eigen::Matrix<double, 9, 1> gradient;
    /// Of the quadratic that touches the loss and, as far as the CDFs are linear in P, lies above it
    /// (iteratively reweighted least squares) but where the CDFs differ by little: positive semidefinite.
    /// gradient^T curvature^-1 gradient is about the loss, 0.03 to 1.2 of it over lobes of all widths.
    Eigen::Matrix<double, 9, 9> curvature;
  };

  /// `cosine`: directions of the clamped cosine, their weights in steps of 2^-25.
  explicit ProjectedCosine(const LobeSamples& cosine);

  /// Loss of the LTC of `m`, in [0, 2], and, where asked for, its derivatives d loss / d m_rc.
  double loss(const ProjectedLobe& lobe, const Eigen::Matrix3d& m, Eigen::Matrix3d* gradient);
  /// The same with derivatives of both orders.
  double loss(const ProjectedLobe& lobe, const Eigen::Matrix3d& m, Derivatives* derivatives);

 private:
  void project(const ProjectedLobe& lobe, const Eigen::Matrix3d& m);
  void addToHistogram(std::size_t n);
  double areaBetweenCdfs(const ProjectedLobe& lobe, const ProjectedSlice& s, std::int32_t first,
                         std::int32_t last);
  void addCurvature(const ProjectedSlice& s, std::int32_t first, std::int32_t last,
                    Eigen::Matrix<double, 9, 9>* curvature);
  Eigen::Matrix3d gradientOfPulls() const;

  std::vector<double> cosX_, cosY_, cosZ_;
  std::vector<std::int32_t> weight_;  // of the cosine samples, in fixed point
  // scratch
  Eigen::Vector3d reference_;
  std::vector<float> x_, y_, z_;
  std::vector<double> invLength_;
  std::vector<float> gx_, gy_, gz_;
  std::vector<std::int32_t> cell_;
  std::vector<std::int32_t> part_;
  std::vector<std::uint64_t> histogram_;
  std::vector<float> sign_;
  std::vector<std::int64_t> difference_;
  std::vector<Eigen::Matrix3d> pull_;          // M^T d y / d (M x) of each sample, times its weight
  std::vector<std::array<double, 9>> motion_;  // of each cell's mass by P
};

/// The two for one lobe.
class ProjectedCdfLoss {
 public:
  ProjectedCdfLoss(const LobeSamples& target, const Eigen::Matrix3d& start, const LobeSamples& cosine,
                   const std::vector<Eigen::Vector3d>& slices)
      : lobe_(target, start, slices), cosine_(cosine) {}

  double operator()(const Eigen::Matrix3d& m, Eigen::Matrix3d* gradient) {
    return cosine_.loss(lobe_, m, gradient);
  }

 private:
  ProjectedLobe lobe_;
  ProjectedCosine cosine_;
};

}  // namespace ltcfit
