#include "fit/light_fit.h"

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "fit/lobe_samples.h"
#include "fit/moment_start.h"
#include "fit/sliced_wasserstein_fit.h"
#include "fit/table_plan.h"
#include "ggx/ggx_lobe.h"
#include "ggx/moments.h"
#include "ltc/ltc.h"
#include "ltc/polygon.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

struct Case {
  explicit Case(const LobeParameters& p)
      : lobe(viewDirection(p.theta, p.phi), {p.alphaX, p.alphaY}),
        truth(lobe),
        albedo(computeMoments(lobe).albedo),
        family(familyOf(p)),
        start(projectOnFamily(momentStart(weightedSamples(lobe, 2048, 3)), family)) {}
  LightTarget target() const { return {truth, albedo, family, start}; }

  GgxLobe lobe;
  ContourIntegrator truth;
  double albedo;
  MatrixFamily family;
  Matrix3d start;
};

const std::vector<LobeParameters>& someLobes() {
  static const std::vector<LobeParameters> lobes{
      {0.5, 0.5, 0.0, 0.0},  {0.3, 0.3, 1.0, 0.0}, {0.05, 0.05, 1.4, 0.0},   {0.6, 0.2, 0.9, 0.6},
      {0.4, 0.05, 1.2, 1.0}, {0.2, 0.1, 0.0, 0.3}, {0.5, 0.1, 0.7, kPi / 2}, {1e-3, 1e-3, 0.8, 0.0}};
  return lobes;
}

// The problem whose answer is known: lights of an LTC.
std::vector<IntegratedLight> planted(std::vector<IntegratedLight> lights, const Matrix3d& m) {
  for (IntegratedLight& l : lights) l.integral = ltcPolygonIntegral(Ltc(m), l.quad);
  return lights;
}

TEST(LightFit, RecoversPlantedMatrices) {
  for (const LobeParameters& p : someLobes()) {
    const Case c(p);
    const PolygonLights lights = makePolygonLights(c.truth, c.albedo, c.start, {});
    std::vector<double> step(familyBasis(c.family).size(), 0.15);
    step.back() = -0.1;
    const Matrix3d m = changedBy(c.start, c.family, step);
    const std::vector<IntegratedLight> known = planted(lights.lights, m);
    LightFitOptions options;
    options.relativeCostTolerance = 1e-12;
    const LightFit fit = solveLightProblem({.lights = &known, .family = c.family}, c.start, options);
    EXPECT_EQ(fit.termination, Termination::kConverged);
    EXPECT_LT(fit.cost, 1e-10 * fit.startCost);
    EXPECT_LT((fit.m - m / m.col(2).norm()).norm(), 1e-3 * fit.m.leftCols<2>().norm())
        << p.alphaX << " " << p.theta;
  }
}

// The problem as Ceres sees it, with a factor on one column of the Jacobian.
class Cost final : public ceres::CostFunction {
 public:
  Cost(const LightProblem& problem, const Matrix3d& base, double factor)
      : problem_(problem), base_(base), factor_(factor), size_(familyBasis(problem.family).size()) {
    set_num_residuals(static_cast<int>(problem.residualCount()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(size_));
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    double* const jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
    if (!problem_.evaluate(base_, parameters[0], residuals, jacobian)) return false;
    if (jacobian != nullptr)
      for (std::size_t j = 0; j < problem_.residualCount(); ++j) jacobian[j * size_] *= factor_;
    return true;
  }

 private:
  const LightProblem& problem_;
  Matrix3d base_;
  double factor_;
  std::size_t size_;
};

TEST(LightProblem, PassesCeresGradientCheckerAndAWrongJacobianDoesNot) {
  for (const LobeParameters& p : someLobes()) {
    const Case c(p);
    PolygonLightOptions few;
    few.lights = 128;
    const PolygonLights lights = makePolygonLights(c.truth, c.albedo, c.start, few);
    const std::vector<double> shift(familyBasis(c.family).size(), -0.1);
    const LightProblem problem{.lights = &lights.lights,
                               .family = c.family,
                               .leak = 2.0,
                               .prior = 1.5,
                               .reference = changedBy(c.start, c.family, shift)};
    const std::array<double, 7> at{0.1, 0.05, 0.1, 0.2, -0.1, 0.1, 0.05};
    const double* const parameters[] = {at.data()};
    ceres::NumericDiffOptions options;
    options.ridders_relative_initial_step_size = 1e-3;
    for (const double factor : {1.0, 1.001}) {
      Cost cost(problem, c.start, factor);
      const ceres::GradientChecker checker(
          &cost, static_cast<const std::vector<const ceres::Manifold*>*>(nullptr), options);
      ceres::GradientChecker::ProbeResults results;
      // 1e-4: differences cross the kink of the second derivative where a vertex meets the horizon
      EXPECT_EQ(checker.Probe(parameters, 1e-4, &results), factor == 1.0)
          << p.alphaX << " " << p.theta << " worst " << results.maximum_relative_error;
    }
  }
}

TEST(LightProblem, LeakResidualsAreTheMassBelow) {
  const std::vector<IntegratedLight> none;
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    Matrix3d m = Matrix3d::Identity();
    for (int k = 0; k < 9; ++k) m(k / 3, k % 3) += 0.4 * random.normal();
    if (m.determinant() <= 0.0) m.col(0) *= -1.0;
    EXPECT_NEAR((LightProblem{.lights = &none, .family = MatrixFamily::kGeneral, .leak = 3.0}.cost(m)),
                4.5 * Ltc(m).massBelowHorizon(), 1e-12);
  }
  EXPECT_TRUE(std::isinf((LightProblem{.lights = &none, .family = MatrixFamily::kGeneral, .leak = 1.0}.cost(
      -Matrix3d::Identity()))));
}

TEST(LightFit, WorksFromAnyStart) {
  for (const LobeParameters& p : someLobes()) {
    const Case c(p);
    const LightFitOptions options = lightFitPreset("fast");
    const LightFit best = fitLights(c.target(), c.start, options);
    EXPECT_EQ(best.termination, Termination::kConverged);
    EXPECT_GT(best.m.determinant(), 0.0);
    EXPECT_LT(best.integralError, 2e-4);
    EXPECT_EQ(projectOnFamily(best.m, c.family), best.m);
    // each fit aims its own lights: judged by those of another seed
    PolygonLightOptions unseen = options.lights;
    unseen.lights = 2048;
    unseen.seed = 98;
    const PolygonLights lights = makePolygonLights(c.truth, c.albedo, best.m, unseen);
    const LightProblem judge{.lights = &lights.lights, .family = c.family};
    // the other winding of the same lobe changes nothing
    LightTarget flipped = c.target();
    flipped.momentStart.col(1) *= -1.0;
    EXPECT_LT((fitLights(flipped, c.start, options).m - best.m).norm(), 1e-9 * best.m.norm());
    // identity; twice as wide; away from the lobe, where gradients vanish
    Matrix3d wide = c.start;
    wide.leftCols<2>() *= 2.0;
    Matrix3d away = c.start;
    away.col(2) = -away.col(2);
    for (const Matrix3d& start : {Matrix3d(Matrix3d::Identity()), wide, projectOnFamily(away, c.family)}) {
      const LightFit fit = fitLights(c.target(), start, options);
      EXPECT_LT(judge.cost(fit.m), 1.03 * judge.cost(best.m))
          << p.alphaX << " " << p.alphaY << " " << p.theta;
    }
    // that is the work of the usual start, which is always tried; alone, a descent arrives from near by
    EXPECT_FALSE(best.restarted);
    const LightProblem own = makeLightProblem(lights.lights, c.target(), best.m, options);
    EXPECT_LT(solveLightProblem(own, wide, options).cost, 1.03 * solveLightProblem(own, best.m, options).cost)
        << p.alphaX << " " << p.alphaY << " " << p.theta;
    EXPECT_FALSE(fitLights(c.target(), wide, options).restarted);
    // and not from a needle that no light sees
    const Matrix3d needle = projectOnFamily(away, c.family) * Vector3d(1e-3, 1e-3, 1.0).asDiagonal();
    EXPECT_TRUE(fitLights(c.target(), needle, options).restarted);
  }
}

TEST(LightFit, LowersTheErrorOfUnseenLights) {
  // against the sliced-Wasserstein fit of the same lobe, over lights of another seed
  double ours = 0.0;
  double theirs = 0.0;
  for (const LobeParameters& p : someLobes()) {
    const Case c(p);
    SlicedWassersteinFitOptions sw = slicedWassersteinPreset("fast");
    const SlicedWassersteinTarget target = makeTarget(c.lobe, c.family, sw);
    ProjectedCdfLoss loss = makeLoss(target, sw.levels.back(), sw.seed);
    const Matrix3d other = fitSlicedWasserstein(target, target.start, sw, loss).m;
    LightFitOptions options = lightFitPreset("standard");
    options.leakWeight = 0.0;
    const Matrix3d m = fitLights(c.target(), c.start, options).m;
    PolygonLightOptions unseen = options.lights;
    unseen.lights = 4096;
    unseen.seed = 99;
    const PolygonLights lights = makePolygonLights(c.truth, c.albedo, other, unseen);
    const LightProblem judge{.lights = &lights.lights, .family = c.family};
    ours += std::sqrt(judge.cost(m));
    theirs += std::sqrt(judge.cost(other));
    EXPECT_LT(judge.cost(m), 1.03 * judge.cost(other)) << p.alphaX << " " << p.alphaY << " " << p.theta;
  }
  EXPECT_LT(ours, 0.95 * theirs);
}

TEST(LightFit, LeakWeightLowersTheMassBelow) {
  const Case c({0.4, 0.4, 1.45, 0.0});
  double last = 1.0;
  for (const double weight : {0.0, 0.1, 1.0, 10.0}) {
    LightFitOptions options = lightFitPreset("fast");
    options.leakWeight = weight;
    const double below = Ltc(fitLights(c.target(), c.start, options).m).massBelowHorizon();
    EXPECT_LT(below, last);
    last = below;
  }
  EXPECT_LT(last, 0.005);
}

TEST(LightFit, HoldsAtTheExtremes) {
  for (const double ax : {1.0, 0.1, 1e-4}) {
    for (const double ratio : {1.0, 0.01}) {
      for (const double theta : {0.0, 1.5, 0.5 * kPi}) {
        for (const double phi : {0.0, 0.3, 0.5 * kPi}) {
          const LobeParameters p{ax, std::max(1e-4, ratio * ax), theta, phi};
          const Case c(p);
          const LightFit fit = fitLights(c.target(), c.start, lightFitPreset("fast"));
          EXPECT_TRUE(fit.m.allFinite() && fit.m.determinant() > 0.0 && isInvertibleInFloat(fit.m))
              << p.alphaX << " " << p.alphaY << " " << theta << " " << phi;
          EXPECT_LE(fit.cost, fit.startCost);
        }
      }
    }
  }
}

TEST(LightFitOptions, AreChecked) {
  std::string error;
  for (const char* const name : {"fast", "standard", "fine"})
    EXPECT_TRUE(lightFitPreset(name).isValid(&error));
  EXPECT_THROW(lightFitPreset("paper"), std::invalid_argument);
  LightFitOptions o;
  o.leakWeight = -1.0;
  EXPECT_FALSE(o.isValid(&error));
  EXPECT_NE(error.find("leak weight"), std::string::npos);
  o = {};
  o.lights.lights = 1;
  EXPECT_FALSE(o.isValid(&error));
  o = {};
  o.maxIterations = 0;
  EXPECT_FALSE(o.isValid(&error));
}

}  // namespace
}  // namespace ltcfit
