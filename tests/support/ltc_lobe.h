// A target that is itself an LTC: what a fit must recover, and where every metric has a known answer.
#pragma once

#include <cmath>

#include "ggx/lobe.h"
#include "ltc/ltc.h"

namespace ltcfit::test {

class LtcLobe final : public Lobe {
 public:
  /// `albedo` scales eval. The lobe keeps its mass below the horizon, if M has any.
  explicit LtcLobe(const Eigen::Matrix3d& m, double albedo = 1.0, double theta = 0.5)
      : Lobe(viewDirection(theta, 0.0)), ltc_(m), albedo_(albedo) {}

  double eval(const Eigen::Vector3d& wi) const override { return albedo_ * ltc_.density(wi); }
  double pdf(const Eigen::Vector3d& wi) const override { return ltc_.density(wi); }
  LobeSample sample(const Eigen::Vector2d& u) const override { return {ltc_.sample(u), albedo_}; }
  bool isIsotropic() const override { return true; }  // M of a planar family
  StretchedNode atStretched(const Eigen::Vector3d& s) const override {
    return {ltc_.transform(s), albedo_ * cosineDensity(s)};
  }
  Eigen::Vector4d stretched(const Eigen::Vector3d& wi) const override {
    const Eigen::Vector3d s = (ltc_.mInv() * wi).normalized();
    return {s.x(), s.y(), s.z(), 0.0};
  }
  StretchedMap toStretched() const override { return {Eigen::Vector3d::Zero(), ltc_.mInv()}; }
  Eigen::Vector2d stretchedAzimuth() const override { return Eigen::Vector2d::UnitX(); }
  double stretchedHorizon(const Eigen::Vector2d&) const override { return 1.0; }

 private:
  Ltc ltc_;
  double albedo_;
};

}  // namespace ltcfit::test
