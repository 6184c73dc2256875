// Integrals of a lobe over the sphere of light directions.
#pragma once

#include <Eigen/Core>

#include "ggx/lobe.h"

namespace ltcfit {

struct MomentsOptions {
  /// A cell of the adaptive rule is split while it changes albedo or fresnel by more than this. The error of
  /// the sum stays below 1e-5 at the default for isotropic lobes, about 1e-4 for anisotropic ones up to
  /// 100:1, at every view and for alpha from 1e-4 (measured: tests/ggx/moments_test.cpp).
  double cellTolerance = 5e-7;
};

struct LobeMoments {
  /// Directional albedo n_D: integral of eval(wi). In (0, 1] for GGX.
  double albedo = 0.0;
  /// Schlick-weighted albedo f_D: integral of eval(wi) (1 - wo.wm)^5. Reflectance for Schlick's Fresnel is
  /// F0 n_D + (1 - F0) f_D.
  double fresnel = 0.0;
  /// Mean of wi under eval / n_D: length in (0, 1], shorter for a wider lobe.
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  /// acos of the mean's length, radians: the width by which metrics are made comparable (SW1rel, form).
  /// Computed without the cancellation of 1 - |mean|, so that it keeps its digits for alpha = 1e-5.
  double spread = 0.0;
  /// Estimated absolute error of albedo and fresnel; an estimate, not a bound.
  double error = 0.0;
};

/// Adaptive integration over the hemisphere.
LobeMoments computeMoments(const Lobe& lobe, const MomentsOptions& options = {});

}  // namespace ltcfit
