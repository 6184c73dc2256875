// What the fitters need of a target lobe. A new BRDF (Beckmann, sheen) is one class derived from Lobe.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace ltcfit {

/// One importance sample of a lobe.
struct LobeSample {
  Eigen::Vector3d wi;  ///< light direction, unit; may lie below the horizon (weight 0)
  double weight;       ///< eval(wi) / pdf(wi), finite
};

/// A light direction with the measure that it stands for, see Lobe::atStretched.
struct StretchedNode {
  Eigen::Vector3d wi;
  double measure;  ///< eval(wi) dwi / ds, >= 0
};

/// The direction s of Lobe::atStretched for unit wi above the horizon: along centre + linear wi. The null
/// vector, where s is undefined, only at wi = -wo and grazing view.
struct StretchedMap {
  Eigen::Vector3d centre;
  Eigen::Matrix3d linear;
};

/// The cosine-weighted BRDF rho(wo, wi) cos theta_i of one view direction, without Fresnel (F = 1): the
/// target of every fit. Its integral over wi is the directional albedo, see moments.h.
class Lobe {
 public:
  virtual ~Lobe() = default;

  /// View direction, unit, wo.z in [0, 1].
  const Eigen::Vector3d& wo() const { return wo_; }

  /// rho(wo, wi) cos theta_i, per steradian, >= 0. Includes the cosine. 0 at and below the horizon.
  virtual double eval(const Eigen::Vector3d& wi) const = 0;

  /// Density of sample() at wi, per steradian, over the whole sphere.
  virtual double pdf(const Eigen::Vector3d& wi) const = 0;

  /// A direction for `u` in [0, 1)^2, with its weight eval / pdf.
  virtual LobeSample sample(const Eigen::Vector2d& u) const = 0;

  /// eval and pdf of many unit directions at once; all spans have one length. The same values as the calls
  /// above to rounding; this is the inner loop of the L3 fit.
  virtual void evalBatch(std::span<const double> x, std::span<const double> y, std::span<const double> z,
                         std::span<double> eval, std::span<double> pdf) const;

  /// Whether the lobe is mirror-symmetric about the plane of incidence, so that its ridges lie in it.
  virtual bool isIsotropic() const = 0;

  /// Four numbers of order 1 for each wi that vary smoothly where the lobe is smooth and fast where it is
  /// sharp: in these coordinates it has no feature narrower than about 1, however small alpha. Guides
  /// quadrature, whose cells are split until they are small in them. NaN where undefined.
  virtual Eigen::Vector4d stretched(const Eigen::Vector3d& wi) const = 0;

  /// The inverse of atStretched.
  virtual StretchedMap toStretched() const = 0;

  /// Azimuth of the view in the stretched configuration, unit: at grazing view the lobe ends across it.
  virtual Eigen::Vector2d stretchedAzimuth() const = 0;

  /// How far the directions above the horizon reach along an azimuth of the stretched configuration: largest
  /// |s.xy| / (1 + s.z) of s in the half plane of the unit vector `azimuth`, in [0, 1]. All of the ray up to
  /// there is above the horizon.
  virtual double stretchedHorizon(const Eigen::Vector2d& azimuth) const = 0;

  /// The lobe in coordinates where it fills the upper hemisphere: for any h,
  ///   integral of eval(wi) h(wi) dwi = integral over unit s with s.z > 0 of measure(s) h(wi(s)) ds.
  /// The measure is bounded and smooth but for kinks (horizon, masking), however small alpha.
  virtual StretchedNode atStretched(const Eigen::Vector3d& s) const = 0;

 protected:
  explicit Lobe(Eigen::Vector3d wo) : wo_(std::move(wo)) {}

 private:
  Eigen::Vector3d wo_;
};

/// View direction for spherical angles in radians, theta from the normal, in [0, pi/2]. At theta = pi/2 (to
/// the last bit of the double) z is exactly 0.
Eigen::Vector3d viewDirection(double theta, double phi);

}  // namespace ltcfit
