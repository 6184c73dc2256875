// The GGX microfacet model: Walter et al. 2007, anisotropic form of Heitz 2014, as printed in KT et al. 2022
// section 3.1. Directions are unit vectors in the shading frame, n = (0, 0, 1).
#pragma once

#include <Eigen/Core>

namespace ltcfit {

/// GGX roughness along x and y. This is alpha, dimensionless, in (0, 1]; the "roughness" of artists is its
/// square root and appears nowhere in ggx/. Smaller than 1e-5 is untested.
struct GgxAlpha {
  double x;
  double y;
};

/// Distribution of normals D(wm), per steradian (KT et al. 2022, eq. 4); 0 for wm.z < 0.
/// Normalised: the integral of D(wm) wm.z over the hemisphere is 1.
double ggxD(const Eigen::Vector3d& wm, GgxAlpha alpha);

/// Smith's Lambda(w) (KT et al. 2022, eq. 5), even in w. +infinity at w.z = 0, where only G1 and the forms of
/// GgxLobe, which multiply it by cos theta first, are of use.
double ggxLambda(const Eigen::Vector3d& w, GgxAlpha alpha);

/// Smith masking G1(w) = 1 / (1 + Lambda(w)), in [0, 1].
double ggxG1(const Eigen::Vector3d& w, GgxAlpha alpha);

/// Height-correlated masking-shadowing G2(wo, wi) = 1 / (1 + Lambda(wo) + Lambda(wi)), in [0, 1]
/// (KT et al. 2022, eq. 5).
double ggxG2(const Eigen::Vector3d& wo, const Eigen::Vector3d& wi, GgxAlpha alpha);

/// Draws a visible normal, density G1(wo) max(0, wo.wm) D(wm) / wo.z per steradian (Heitz 2018, "Sampling the
/// GGX Distribution of Visible Normals"). `u` in [0, 1)^2; wo.z in [0, 1], 0 included: the projected disk is
/// then cut in half, and nothing divides by cos theta.
Eigen::Vector3d sampleGgxVisibleNormal(const Eigen::Vector3d& wo, GgxAlpha alpha, const Eigen::Vector2d& u);

}  // namespace ltcfit
