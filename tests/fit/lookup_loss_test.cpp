#include "fit/lookup_loss.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>

#include "ggx/random.h"
#include "ltc/ltc.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

constexpr double kHalfPi = 0.5 * std::numbers::pi;

LookUpLossOptions fewOptions() {
  return {.slices = 16,
          .targetSamples = 2048,
          .samples = 256,
          .lights = {.lights = 48, .sizeExponent = 0.0},
          .quads = 24};
}

// Wide, stretched, at grazing view, narrow, and a needle.
const std::vector<LobeParameters> kLobes{{1.0, 1.0, 0.0, 0.0},
                                         {0.5, 0.2, 0.8, 0.5},
                                         {0.6, 0.3, kHalfPi, 0.9},
                                         {0.01, 0.005, 0.6, 0.2},
                                         {1e-4, 1e-4, 1.2, 0.0}};

// Near the lobe: that of a mirror direction, tilted and stretched.
Matrix3d nearLobe(const LobeParameters& p) {
  Matrix3d m;
  const double s = std::sin(p.theta);
  m << p.alphaX * std::max(0.2, std::cos(p.theta)), 0.1 * p.alphaY, -s * std::cos(p.phi), 0.0, p.alphaY,
      -s * std::sin(p.phi), p.alphaX * s, 0.0, std::max(0.2, std::cos(p.theta));
  return m;
}

Matrix3d changed(const Matrix3d& m, const Vector9d& v) {
  Matrix3d p;
  for (Eigen::Index k = 0; k < 9; ++k) p(k / 3, k % 3) = v[k];
  return m * (Matrix3d::Identity() + p);
}

TEST(LookUpLoss, ValueIsTheSameWithAndWithoutDerivatives) {
  LookUpSamples samples(fewOptions());
  for (const LobeParameters& p : kLobes) {
    LookUpLoss loss(p, "ggx", fewOptions(), 3, samples);
    loss.setWeights({0.7, 1.1, 0.4});
    LossDerivatives d;
    const double with = loss(nearLobe(p), samples, &d);
    EXPECT_NEAR(with / loss(nearLobe(p), samples, nullptr), 1.0, 1e-12);
    EXPECT_GT(with, 0.0);
    const LookUpErrors e = loss.errors(nearLobe(p), samples);
    // what is left is the leak's
    const double leak = with - (0.7 * e.sw + 1.1 * e.form + 0.4 * e.light);
    const double below = Ltc(nearLobe(p)).massBelowHorizon();
    EXPECT_GE(leak, -1e-15);
    EXPECT_LE(leak, 0.4 * 0.5 * fewOptions().leakWeight * below * 1.001 + 1e-15) << "albedo is at most 1";
    EXPECT_GE(leak, 0.4 * 0.5 * fewOptions().leakWeight * below * 0.2 - 1e-15);
  }
}

TEST(LookUpLoss, GradientAgreesWithDifferences) {
  LookUpLossOptions options = fewOptions();
  options.leakWeight = 5.0;
  LookUpSamples samples(options);
  Random random(2);
  for (const LobeParameters& p : kLobes) {
    LookUpLoss loss(p, "ggx", options, 3, samples);
    const Matrix3d m = nearLobe(p);
    // lights and leak, which are smooth (integrals over a needle lose digits), one after the other; then
    // slices, up to the noise of their cells
    const std::vector<std::pair<LookUpErrors, double>> parts{
        {{0.0, 1.0, 0.0}, 1e-4}, {{0.0, 0.0, 1.0}, 1e-4}, {{1.0, 0.0, 0.0}, 0.1}};
    for (const auto& [weights, tolerance] : parts) {
      SCOPED_TRACE(testing::Message() << "alpha " << p.alphaX << ", weights " << weights.sw << " "
                                      << weights.form << " " << weights.light);
      loss.setWeights(weights);
      LossDerivatives d;
      loss(m, samples, &d);
      ASSERT_GT(d.gradient.norm(), 0.0);
      const double h = weights.sw > 0.0 ? 3e-5 : 1e-6 * std::min(1.0, 300.0 * p.alphaY);
      Vector9d difference;
      for (Eigen::Index k = 0; k < 9; ++k) {
        const Vector9d step = h * Vector9d::Unit(k);
        difference[k] =
            (loss(changed(m, step), samples, nullptr) - loss(changed(m, -step), samples, nullptr)) /
            (2.0 * h);
      }
      EXPECT_LT((difference - d.gradient).norm(), tolerance * d.gradient.norm());
      EXPECT_GT((difference - 1.2 * d.gradient).norm(), tolerance * d.gradient.norm()) << "20 % off";
    }
  }
}

TEST(LookUpLoss, CurvatureIsSemidefiniteAndBoundsTheGradient) {
  LookUpSamples samples(fewOptions());
  for (const LobeParameters& p : kLobes) {
    LookUpLoss loss(p, "ggx", fewOptions(), 3, samples);
    for (const LookUpErrors& weights :
         {LookUpErrors{1.0, 1.0, 1.0}, LookUpErrors{0.0, 1.0, 0.0}, LookUpErrors{0.0, 0.0, 1.0}}) {
      loss.setWeights(weights);
      for (const Matrix3d& m : {nearLobe(p), Matrix3d(Matrix3d::Identity()),
                                Matrix3d(nearLobe(p) * Eigen::Vector3d(3.0, 0.4, 1.0).asDiagonal())}) {
        LossDerivatives d;
        const double value = loss(m, samples, &d);
        EXPECT_LT((d.curvature - d.curvature.transpose()).norm(), 1e-12 * d.curvature.norm());
        const double trace = d.curvature.trace();
        EXPECT_GT(trace, 0.0);
        const Matrix9d regular = d.curvature + 1e-9 * trace * Matrix9d::Identity();
        const Eigen::LLT<Matrix9d> llt(regular);
        EXPECT_EQ(llt.info(), Eigen::Success);
        EXPECT_LT(d.gradient.dot(llt.solve(d.gradient)), 2.0 * value) << p.alphaX << " " << weights.sw;
      }
    }
  }
}

TEST(LookUpLoss, QuadraticLiesAboveTheLightParts) {
  LookUpSamples samples(fewOptions());
  Random random(2);
  for (const LobeParameters& p : kLobes) {
    LookUpLoss loss(p, "ggx", fewOptions(), 3, samples);
    loss.setWeights({0.0, 1.0, 1.0});
    const Matrix3d m = nearLobe(p);
    LossDerivatives d;
    const double value = loss(m, samples, &d);
    for (int i = 0; i < 30; ++i) {
      Vector9d v;
      for (Eigen::Index k = 0; k < 9; ++k) v[k] = random.normal();
      // by lobes' own widths: row 2 of P moves a needle by 1 / alpha of them
      v.tail<3>() *= std::min(1.0, p.alphaY);
      v *= 1e-3 / v.norm();
      const double quadratic = value + d.gradient.dot(v) + 0.5 * v.dot(d.curvature * v);
      // integrals are linear in P but for their own second derivatives
      EXPECT_LT(loss(changed(m, v), samples, nullptr), quadratic + 1e-4 * value) << p.alphaX;
    }
  }
}

TEST(LookUpLoss, WeightsScaleItAndOneIsTheDefault) {
  const LobeParameters p = kLobes[1];
  LookUpSamples samples(fewOptions());
  LookUpLoss loss(p, "ggx", fewOptions(), 3, samples);
  LossDerivatives one;
  const double value = loss(nearLobe(p), samples, &one);
  loss.setWeights({1.0, 1.0, 1.0});
  EXPECT_EQ(loss(nearLobe(p), samples, nullptr), loss(nearLobe(p), samples, nullptr));
  LossDerivatives three;
  loss.setWeights({3.0, 3.0, 3.0});
  EXPECT_NEAR(loss(nearLobe(p), samples, &three), 3.0 * value, 1e-14);
  EXPECT_LT((three.gradient - 3.0 * one.gradient).norm(), 1e-13 * three.gradient.norm());
  EXPECT_LT((three.curvature - 3.0 * one.curvature).norm(), 1e-13 * three.curvature.norm());
}

TEST(LookUpLoss, WhereThereIsNoLtcItIsFlat) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Matrix3d notANumber = Matrix3d::Identity();
  notANumber(0, 1) = nan;
  Matrix3d singular = Matrix3d::Identity();
  singular(1, 1) = 0.0;
  const Matrix3d mirrored = -Matrix3d::Identity();
  Matrix3d below = Matrix3d::Identity();
  below(0, 0) = below(2, 2) = -1.0;  // det = 1
  Matrix3d tiny = 1e-200 * Matrix3d::Identity();
  LookUpSamples samples(fewOptions());
  LookUpLoss loss(kLobes[1], "ggx", fewOptions(), 3, samples);
  loss.setWeights({2.0, 3.0, 5.0});
  for (const Matrix3d& m : {notANumber, singular, mirrored, below, tiny}) {
    EXPECT_FALSE(LookUpLoss::isLtc(m)) << m;
    LossDerivatives d{Vector9d::Ones(), Matrix9d::Ones()};
    EXPECT_EQ(loss(m, samples, &d), 10.0);
    EXPECT_EQ(loss(m, samples, nullptr), 10.0);
    EXPECT_EQ(d.gradient.norm(), 0.0);
    EXPECT_EQ(d.curvature.norm(), 0.0);
  }
  // all but below: there is an LTC, and derivatives lead back
  below(2, 0) = 1e-3;
  EXPECT_TRUE(LookUpLoss::isLtc(below));
  LossDerivatives d;
  EXPECT_TRUE(std::isfinite(loss(below, samples, &d)));
  EXPECT_TRUE(d.gradient.allFinite());
  EXPECT_TRUE(d.curvature.allFinite());
  EXPECT_TRUE(LookUpLoss::isLtc(Matrix3d::Identity()));
}

TEST(LookUpLoss, DirectFitIsBetterThanARoughGuess) {
  LookUpSamples samples(fewOptions());
  for (const LobeParameters& p : kLobes) {
    const LookUpLoss loss(p, "ggx", fewOptions(), 3, samples);
    const LookUpErrors guess = loss.errors(nearLobe(p), samples);
    for (const double e : {loss.direct().sw, loss.direct().form, loss.direct().light}) EXPECT_GT(e, 0.0);
    EXPECT_LT(loss.direct().sw, guess.sw);
    EXPECT_LT(loss.direct().sw, 0.5 * loss.spread()) << "the lobe is met to a part of its width";
    EXPECT_LT(loss.direct().form, guess.form);
    EXPECT_EQ(loss.parameters().alphaX, p.alphaX);
    EXPECT_GT(loss.spread(), 0.0);
    EXPECT_LT(loss.spread(), 1.6);
  }
}

TEST(LookUpLoss, IsGivenByItsSeed) {
  LookUpSamples samples(fewOptions());
  const LobeParameters p = kLobes[1];
  const LookUpLoss a(p, "ggx", fewOptions(), 3, samples);
  const LookUpLoss b(p, "ggx", fewOptions(), 3, samples);
  const LookUpLoss c(p, "ggx", fewOptions(), 4, samples);
  EXPECT_EQ(a(nearLobe(p), samples, nullptr), b(nearLobe(p), samples, nullptr));
  EXPECT_NE(a(nearLobe(p), samples, nullptr), c(nearLobe(p), samples, nullptr));
  // other quads, lights and slices of the same lobe
  EXPECT_NEAR(a(nearLobe(p), samples, nullptr) / c(nearLobe(p), samples, nullptr), 1.0, 0.5);
  EXPECT_THROW(LookUpLoss(p, "beckmann", fewOptions(), 3, samples), std::invalid_argument);
}

TEST(LookUpLoss, OptionsAreChecked) {
  std::string error;
  EXPECT_TRUE(LookUpLossOptions{}.isValid(&error));
  EXPECT_TRUE(fewOptions().isValid(&error));
  const auto refuses = [&](const char* part, const auto& change) {
    LookUpLossOptions o;
    change(o);
    error.clear();
    EXPECT_FALSE(o.isValid(&error)) << part;
    EXPECT_NE(error.find(part), std::string::npos) << error;
  };
  refuses("slices = 3,", [](auto& o) { o.slices = 3; });
  refuses("target samples = 2047,", [](auto& o) { o.targetSamples = 2047; });
  refuses("samples = 65537,", [](auto& o) { o.samples = 65537; });
  refuses("quads = 15,", [](auto& o) { o.quads = 15; });
  refuses("leak weight", [](auto& o) { o.leakWeight = std::nan(""); });
  refuses("lights = 15,", [](auto& o) { o.lights.lights = 15; });
}

}  // namespace
}  // namespace ltcfit
