// Least squares over polygon lights: the residual is what a renderer computes.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "fit/matrix_family.h"
#include "fit/optimizer.h"
#include "fit/polygon_lights.h"

namespace ltcfit {

struct LightFitOptions {
  PolygonLightOptions lights;
  /// Mass below the horizon counts leakWeight times the RMS light error of the start, 0..100: see lightCost.
  double leakWeight = 0.05;
  int maxIterations = 50;  ///< of Levenberg-Marquardt
  double relativeCostTolerance = 1e-4;

  bool isValid(std::string* error) const;
};

/// Options by name: "fast" (the default of isotropic tables), "standard" (of anisotropic ones) and "fine":
/// numbers of lights. Throws Refusal for another name.
LightFitOptions lightFitPreset(std::string_view name);

/// The least-squares problem about a matrix: residuals
///   weight_j (integral of the LTC of m over light j - integral_j), one for each light,
///   leak v.x / (2 |v| cos(psi / 2)) and the same with v.y, v = row 2 of m, psi its angle to the normal:
///   their squares add up to leak^2 times the mass below the horizon, sin(psi / 2)^2 (Ltc::massBelowHorizon),
///   prior <B_k, Q> / (tr Q / 3), Q = reference^-1 m, one for each matrix B_k of familyBasis(): how far m is
///   from a reference. It decides what no light sees, as the small axis of a needle.
struct LightProblem {
  const std::vector<IntegratedLight>* lights;
  MatrixFamily family;
  double leak = 0.0;
  double prior = 0.0;
  Eigen::Matrix3d reference = Eigen::Matrix3d::Identity();  ///< det != 0

  std::size_t residualCount() const { return lights->size() + 2 + familyBasis(family).size(); }
  /// Half the sum of squares.
  double cost(const Eigen::Matrix3d& m) const;
  /// Residuals at base (I + sum of p_k B_k) and, unless null, their derivatives by p: residualCount() rows of
  /// one column for each matrix of familyBasis(). False where the matrix has no positive determinant, tr Q is
  /// not positive, or the whole lobe lies below the horizon.
  bool evaluate(const Eigen::Matrix3d& base, const double* p, double* residuals, double* jacobian) const;
};

struct LightFit {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();  ///< det > 0, third column of length 1
  double startCost = 0.0;                           ///< LightProblem::cost of the start
  double cost = 0.0;                                ///< at the end
  int evaluations = 0;
  Termination termination = Termination::kFailure;
  double integralError = 0.0;  ///< PolygonLights::integralError, where fitLights made the lights
  bool restarted = false;      ///< fitLights: the start's own descent did not arrive
};

/// What a fit knows of its lobe.
struct LightTarget {
  const ContourIntegrator& truth;
  double albedo;
  MatrixFamily family;
  Eigen::Matrix3d momentStart;  ///< a matrix of the family that overlaps the lobe
};

/// The problem over lights of which `near` explains much, its other weights in units of the light error e of
/// `near` (RMS): leak^2 below is leakWeight n e below next to the n squares, the change of their RMS with the
/// mass below in multiples of leakWeight / 2; the prior makes a step of 1, about the whole matrix, cost a
/// tenth of n e^2. Keeps a reference to `lights`.
LightProblem makeLightProblem(const std::vector<IntegratedLight>& lights, const LightTarget& target,
                              const Eigen::Matrix3d& near, const LightFitOptions& options);

/// Minimises the problem over the matrices of its family from `start`, det > 0, by Levenberg-Marquardt
/// (Ceres, dense QR).
LightFit solveLightProblem(const LightProblem& problem, const Eigen::Matrix3d& start,
                           const LightFitOptions& options);

/// Two rounds: few lights about target.momentStart, then all about what these gave. The first one descends
/// from `start` (of the family, det != 0) and from target.momentStart, and keeps the latter's minimum unless
/// the former's is lower by a tenth: what is left of a start is what it found better. Costs are those of the
/// second round, evaluations those of both.
LightFit fitLights(const LightTarget& target, const Eigen::Matrix3d& start, const LightFitOptions& options);

}  // namespace ltcfit
