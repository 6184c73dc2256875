// The GGX lobe as a fit target: density, sampling and rejection, valid up to grazing view (theta = 90
// degrees).
#pragma once

#include <optional>

#include "ggx/ggx.h"
#include "ggx/lobe.h"

namespace ltcfit {

/// Cosine-weighted GGX with height-correlated Smith masking and F = 1 (KT et al. 2022, eq. 6).
///
/// Everything goes through a(w) = sqrt(z^2 + ax^2 x^2 + ay^2 y^2), for which 1 + 2 Lambda(w) = a(w) / |z|:
///   eval = D(wm) cos_i / (2 (a(wo) cos_i + a(wi) cos_o)),   pdf = D(wm) / (2 (cos_o + a(wo))),
/// finite at cos_o = 0, where the printed D G2 / (4 cos_o) is 0/0 (math: DESIGN.md, "Grazing view").
class GgxLobe final : public Lobe {
 public:
  /// `wo` unit with wo.z >= 0, alpha in (0, 1]. Anything else is a caller's bug and aborts.
  GgxLobe(const Eigen::Vector3d& wo, GgxAlpha alpha);

  double eval(const Eigen::Vector3d& wi) const override;

  /// Density of the reflected visible normal, G1(wo) D(wm) / (4 cos_o).
  double pdf(const Eigen::Vector3d& wi) const override;

  /// Reflects a visible normal. The weight is G2 / G1(wo), in [0, 1], 0 below the horizon.
  LobeSample sample(const Eigen::Vector2d& u) const override;

  void evalBatch(std::span<const double> x, std::span<const double> y, std::span<const double> z,
                 std::span<double> eval, std::span<double> pdf) const override;

  /// sample() for many points u = (u0, u1) at once, to rounding; all spans have one length.
  void sampleBatch(std::span<const double> u0, std::span<const double> u1, std::span<double> x,
                   std::span<double> y, std::span<double> z, std::span<double> weight) const;

  /// The half vector in the configuration of roughness 1, where D is the fourth power of its cosine, and G2 /
  /// G1(wo), which at grazing view falls to 0 in a thin layer at the horizon.
  Eigen::Vector4d stretched(const Eigen::Vector3d& wi) const override;

  bool isIsotropic() const override { return alpha_.x == alpha_.y; }

  /// s is the half vector in the configuration of roughness 1: D wm.z dwm = s.z ds / pi, and dwi = 4 wo.wm
  /// dwm.
  StretchedNode atStretched(const Eigen::Vector3d& s) const override;

  /// The half vector, stretched.
  StretchedMap toStretched() const override;

  Eigen::Vector2d stretchedAzimuth() const override;

  double stretchedHorizon(const Eigen::Vector2d& azimuth) const override;

  /// Probability to keep a reflected visible normal so that the kept ones follow eval exactly:
  /// G2 / G1(wo) = (1 + Lambda(wo)) / (1 + Lambda(wo) + Lambda(wi)), 0 at and below the horizon.
  /// KT et al. 2022 print (1 + Lambda(wi)) in the numerator, in section 3.1 and Algorithm 1; that does not
  /// sample the BRDF, and a test holds it against this one.
  double acceptance(const Eigen::Vector3d& wi) const;

  /// One try of KT et al. 2022, Algorithm 1 with the weight above: `u` in [0, 1)^2 picks the normal,
  /// `uAccept` in [0, 1) decides. Empty when rejected. The accepted directions have density eval / albedo.
  std::optional<Eigen::Vector3d> sampleByRejection(const Eigen::Vector2d& u, double uAccept) const;

  GgxAlpha alpha() const { return alpha_; }

 private:
  GgxAlpha alpha_;
  double stretchedWo_;  // a(wo)
};

}  // namespace ltcfit
