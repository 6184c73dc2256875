// One Linearly Transformed Cosine: density, sampling, Jacobian, derivatives.
#pragma once

#include <Eigen/Core>

namespace ltcfit {

/// Normalised clamped cosine max(0, z) / pi, per steradian (Heitz et al. 2016, eq. 4).
double cosineDensity(const Eigen::Vector3d& w);

/// A direction of that density for `u` in [0, 1)^2: the disk is mapped by radius and azimuth, then lifted.
Eigen::Vector3d sampleCosine(const Eigen::Vector2d& u);

/// The distribution of M x / |M x| for x from the clamped cosine (Heitz et al. 2016, section 3). It
/// integrates to 1 over the sphere; part of it may lie below the horizon. Invariant under M -> s M (s > 0)
/// and under M -> M R with R a rotation about z or a flip of x or y.
class Ltc {
 public:
  /// `m` finite with det m != 0; the lobe of a singular matrix is not a density and aborts as a caller's bug.
  explicit Ltc(const Eigen::Matrix3d& m);

  const Eigen::Matrix3d& m() const { return m_; }
  const Eigen::Matrix3d& mInv() const { return mInv_; }
  double det() const { return det_; }

  /// Density at the unit direction w, per steradian (eq. 1).
  double density(const Eigen::Vector3d& w) const;

  /// d density / d M_rc at w, 3x3, for the derivative at a general matrix. Zero where the density is zero;
  /// not defined on the boundary of the support (the density is continuous there, its derivative is not).
  Eigen::Matrix3d densityGradient(const Eigen::Vector3d& w) const;

  /// The direction M x / |M x| of a cosine sample x.
  Eigen::Vector3d transform(const Eigen::Vector3d& x) const { return (m_ * x).normalized(); }

  /// Draws from the density, `u` in [0, 1)^2 (Algorithm 1).
  Eigen::Vector3d sample(const Eigen::Vector2d& u) const { return transform(sampleCosine(u)); }

  /// d omega / d omega_o at the unit original direction x: |det M| / |M x|^3 (eq. 18).
  double jacobian(const Eigen::Vector3d& x) const;

  /// d omega_o / d omega at the unit direction w: |det M^-1| / |M^-1 w|^3 (eq. 19).
  double inverseJacobian(const Eigen::Vector3d& w) const;

  /// Mass below the horizon, in [0, 1], in closed form: M x points down where row 2 of M times x does, and
  /// the cosine mass of a half space through the origin with unit normal v is (1 + v.z) / 2.
  double massBelowHorizon() const;

 private:
  Eigen::Matrix3d m_;
  Eigen::Matrix3d mInv_;
  double det_;
};

/// Whether float32 arithmetic, a shader's, can invert the matrix: finite entries, det != 0 and finite, a
/// finite inverse.
bool isInvertibleInFloat(const Eigen::Matrix3d& m);

}  // namespace ltcfit
