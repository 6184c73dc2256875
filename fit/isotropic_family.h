// The matrices among which an isotropic entry is sought, and the parameters that a simplex moves in.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>
#include <vector>

namespace ltcfit {

/// Which matrices are allowed; both keep the lobe's mirror symmetry about the x-z plane.
enum class IsotropicFamily {
  /// [a 0 b; 0 c 0; d 0 1], 4 parameters (Heitz et al. 2016, eq. 6): every symmetric LTC.
  kPlane4,
  /// R [p 0 t; 0 q 0; 0 0 1] with R the frame of the lobe's mean direction, 3 parameters: what the authors of
  /// the 2016 paper published code for, and the family of the table of 2017.
  kMeanFrame3,
};

/// "4" or "3": the family as the command line names it.
std::string_view familyName(IsotropicFamily family);

/// Frame of a direction in the x-z plane: columns X, Y = y, Z = direction; a rotation about y.
Eigen::Matrix3d frameAbout(const Eigen::Vector3d& direction);

/// Parameters of one entry, scaled so that a step of 0.1 in any of them changes the lobe by about a tenth of
/// its own width, for alpha = 1e-4 as for alpha = 1 (the raw entries of M differ in scale by 1/alpha):
///   kPlane4:     M = R(psi) [p 0 0; 0 q 0; s 0 1],     parameters log p, log q, s, (psi - psi_0) / p_0
///   kMeanFrame3: M = R(mean) [p 0 t; 0 q 0; 0 0 1],    parameters log p, log q, t / p_0
///   view along the normal: M = diag(p, p, 1),          parameter  log p
/// with psi_0, p_0 those of the start. p, q > 0, so that det M > 0 by construction.
class IsotropicParametrization {
 public:
  /// `mean` is the lobe's mean direction (any length > 0, y = 0); `start` a matrix of the family, any scale.
  IsotropicParametrization(IsotropicFamily family, bool normalView, const Eigen::Vector3d& mean,
                           const Eigen::Matrix3d& start);

  /// Parameters of the start matrix, and the edge lengths of a first simplex.
  const std::vector<double>& start() const { return start_; }
  std::vector<double> steps(double edge) const { return std::vector<double>(start_.size(), edge); }

  /// The matrix of these parameters.
  Eigen::Matrix3d matrix(std::span<const double> parameters) const;

 private:
  IsotropicFamily family_;
  bool normalView_;
  Eigen::Matrix3d frame_;  // R(mean) or R(psi_0)
  double scale_ = 1.0;     // p_0
  std::vector<double> start_;
};

}  // namespace ltcfit
