// What one look-up of a table costs against the lobe that it stands for: the residuals of joint refinement.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fit/polygon_lights.h"
#include "fit/projected_cdf_loss.h"
#include "ltc/table.h"

namespace ltcfit {

/// How closely a look-up is judged.
struct LookUpLossOptions {
  int slices = 24;           ///< of the sliced Wasserstein distance, 4..1024
  int targetSamples = 4096;  ///< directions of the lobe for it, 2048..1048576
  int samples = 768;  ///< directions of the LTC, 16..65536; eight times as many for lobes narrower than 0.01
  PolygonLightOptions lights{.lights = 128, .sizeExponent = 0.0};  ///< over the whole hemisphere
  int quads = 64;                                                  ///< about the lobe, 16..65536
  /// Mass below the horizon counts leakWeight / 2 times in the light error (LightFitOptions), 0..100.
  double leakWeight = 0.05;

  /// False with a message naming the option, its value and its range.
  bool isValid(std::string* error) const;
};

/// Errors of an LTC, all >= 0.
struct LookUpErrors {
  double sw = 0.0;     ///< sliced Wasserstein distance to the lobe, 0..2
  double form = 0.0;   ///< root mean square over quads about the lobe, as in the metric form
  double light = 0.0;  ///< n_D times the weighted root mean square over lights (makePolygonLights)
};

/// By P of M (I + P) at P = 0, row by row.
struct LossDerivatives {
  Eigen::Matrix<double, 9, 1> gradient;
  /// Of a quadratic that touches the loss and, where its parts are linear in P, lies above it (but see
  /// ProjectedCosine::Derivatives): positive semidefinite, gradient^T curvature^-1 gradient below 2 loss.
  Eigen::Matrix<double, 9, 9> curvature;
};

/// Directions of the LTC, the same for every look-up. Not thread-safe.
class LookUpSamples {
 public:
  explicit LookUpSamples(const LookUpLossOptions& options);
  /// Those for a lobe: more for a narrow one, whose tails are all of its distance.
  ProjectedCosine& of(bool narrow) { return narrow ? many_ : few_; }

 private:
  ProjectedCosine few_;
  ProjectedCosine many_;
};

/// The lobe of one look-up. Immutable but for its weights.
class LookUpLoss {
 public:
  /// `seed` draws lights and quads and turns the slices. `options` valid, `samples` made with them. Throws
  /// Refusal for an unknown brdf.
  LookUpLoss(const LobeParameters& parameters, std::string_view brdf, const LookUpLossOptions& options,
             std::uint64_t seed, LookUpSamples& samples);

  const LobeParameters& parameters() const { return parameters_; }
  /// acos of the length of the lobe's mean direction, radians.
  double spread() const { return spread_; }
  /// Of a quick direct fit of the lobe (sliced Wasserstein): what a look-up can have.
  const LookUpErrors& direct() const { return direct_; }

  /// What each error is multiplied with in the loss, >= 0; all 1 at first.
  void setWeights(const LookUpErrors& weights) { weights_ = weights; }

  /// sw + form + (light + n_D leakWeight / 2 mass below the horizon), each times its weight. Where `m` is no
  /// LTC's (det 0, not finite, the whole lobe below the horizon) as for errors of 1, derivatives 0.
  double operator()(const Eigen::Matrix3d& m, LookUpSamples& samples, LossDerivatives* derivatives) const;

  /// Whether there is an LTC of the matrix whose lobe is not all below the horizon: finite, det != 0.
  static bool isLtc(const Eigen::Matrix3d& m);

  /// Of an LTC's matrix (isLtc).
  LookUpErrors errors(const Eigen::Matrix3d& m, LookUpSamples& samples) const;

 private:
  LobeParameters parameters_;
  double albedo_;
  double spread_;
  double leakWeight_;
  bool narrow_ = false;
  std::vector<ProjectedLobe> projected_;  // one; made after the lobe's samples
  std::vector<IntegratedLight> lights_;
  std::vector<IntegratedLight> quads_;
  LookUpErrors direct_;
  LookUpErrors weights_{1.0, 1.0, 1.0};
};

}  // namespace ltcfit
