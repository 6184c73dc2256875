#include "ggx/ggx.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "ggx/ggx_lobe.h"
#include "ggx/random.h"
#include "ggx/sin_cos.h"

namespace ltcfit {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

Vector3d direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

TEST(Ggx, DistributionOfNormalsIsNormalised) {
  for (const GgxAlpha alpha : {GgxAlpha{1.0, 1.0}, GgxAlpha{0.3, 0.7}, GgxAlpha{0.2, 0.05}}) {
    // midpoint rule in cos^2 of the stretched cap would be exact by construction; plain spherical angles are
    // not
    double sum = 0.0;
    const int n = 2000;
    const int m = 200;
    for (int i = 0; i < n; ++i) {
      const double theta = 0.5 * kPi * (i + 0.5) / n;
      for (int j = 0; j < m; ++j) {
        const Vector3d wm = direction(theta, 2.0 * kPi * (j + 0.5) / m);
        sum += ggxD(wm, alpha) * wm.z() * std::sin(theta);
      }
    }
    sum *= 0.5 * kPi / n * 2.0 * kPi / m;
    EXPECT_NEAR(sum, 1.0, 1e-4) << alpha.x << " " << alpha.y;  // midpoint error at these steps
  }
}

TEST(Ggx, NormalsBelowTheHorizonDoNotExist) {
  EXPECT_EQ(ggxD({0.0, 0.6, -0.8}, {0.5, 0.5}), 0.0);
}

TEST(Ggx, MaskingMatchesTheProjectedArea) {
  // Smith's G1 is defined by: integral of G1 max(0, wo.wm) D dwm = cos theta_o (Heitz 2014, eq. 14)
  const GgxAlpha alpha{0.4, 0.15};
  const Vector3d wo = direction(70.0 * kDegree, 0.4);
  double sum = 0.0;
  const int n = 2000;
  const int m = 400;
  for (int i = 0; i < n; ++i) {
    const double theta = 0.5 * kPi * (i + 0.5) / n;
    for (int j = 0; j < m; ++j) {
      const Vector3d wm = direction(theta, 2.0 * kPi * (j + 0.5) / m);
      sum += std::max(0.0, wo.dot(wm)) * ggxD(wm, alpha) * std::sin(theta);
    }
  }
  sum *= 0.5 * kPi / n * 2.0 * kPi / m;
  EXPECT_NEAR(ggxG1(wo, alpha) * sum, wo.z(), 1e-4);
}

TEST(Ggx, LambdaKeepsItsDigitsForSmoothSurfaces) {
  // (sqrt(1 + t) - 1) / 2 with t = 1e-18 is 0 when written so; its value is t / 4
  EXPECT_NEAR(ggxLambda(direction(45.0 * kDegree, 0.0), {1e-9, 1e-9}) / 2.5e-19, 1.0, 1e-6);
  EXPECT_TRUE(std::isinf(ggxLambda({1.0, 0.0, 0.0}, {0.5, 0.5})));
  EXPECT_EQ(ggxG1({1.0, 0.0, 0.0}, {0.5, 0.5}), 0.0);
}

TEST(GgxLobe, IsThePrintedFormulaAwayFromGrazing) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const GgxAlpha alpha{0.02 + 0.98 * random.uniform(), 0.02 + 0.98 * random.uniform()};
    const Vector3d wo = direction(1.4 * random.uniform(), 6.0 * random.uniform());
    const Vector3d wi = direction(1.5 * random.uniform(), 6.0 * random.uniform());
    const Vector3d wm = (wo + wi).normalized();
    const double printed = ggxD(wm, alpha) * ggxG2(wo, wi, alpha) / (4.0 * wo.z());
    const GgxLobe lobe(wo, alpha);
    EXPECT_NEAR(lobe.eval(wi) / printed, 1.0, 1e-12);
    EXPECT_NEAR(lobe.pdf(wi) / (ggxG1(wo, alpha) * ggxD(wm, alpha) / (4.0 * wo.z())), 1.0, 1e-12);
    EXPECT_NEAR(lobe.acceptance(wi) / (ggxG2(wo, wi, alpha) / ggxG1(wo, alpha)), 1.0, 1e-12);
  }
}

TEST(GgxLobe, IsReciprocal) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const GgxAlpha alpha{0.01 + 0.99 * random.uniform(), 0.01 + 0.99 * random.uniform()};
    const Vector3d a = direction(1.57 * random.uniform(), 6.0 * random.uniform());
    const Vector3d b = direction(1.57 * random.uniform(), 6.0 * random.uniform());
    EXPECT_NEAR(GgxLobe(a, alpha).eval(b) / b.z() / (GgxLobe(b, alpha).eval(a) / a.z()), 1.0, 1e-11);
  }
}

TEST(GgxLobe, GrazingViewIsTheLimit) {
  const GgxAlpha alpha{0.3, 0.3};
  const GgxLobe grazing(viewDirection(0.5 * kPi, 0.0), alpha);
  EXPECT_EQ(grazing.wo().z(), 0.0);
  for (double elevation : {0.05, 0.3, 0.9}) {
    const Vector3d wi = direction(0.5 * kPi - elevation, kPi - 0.2);
    const GgxLobe nearly(viewDirection(0.5 * kPi - 1e-7, 0.0), alpha);
    EXPECT_TRUE(std::isfinite(grazing.eval(wi)));
    EXPECT_NEAR(grazing.eval(wi) / nearly.eval(wi), 1.0, 1e-5);  // linear in the angle
    EXPECT_EQ(grazing.acceptance(wi), 1.0);
  }
}

TEST(GgxLobe, NothingComesFromBelow) {
  const GgxLobe lobe(viewDirection(1.2, 0.3), {0.5, 0.2});
  EXPECT_EQ(lobe.eval({0.6, 0.0, -0.8}), 0.0);
  EXPECT_EQ(lobe.eval({1.0, 0.0, 0.0}), 0.0);
  EXPECT_EQ(lobe.acceptance({0.6, 0.0, -0.8}), 0.0);
}

TEST(GgxLobe, BatchIsTheSameFunction) {
  Random random(3);
  for (double theta : {0.0, 0.8, 1.5, 0.5 * kPi}) {
    for (const GgxAlpha alpha : {GgxAlpha{1.0, 1.0}, GgxAlpha{1e-4, 1e-4}, GgxAlpha{0.5, 0.005}}) {
      const GgxLobe lobe(viewDirection(theta, 0.3), alpha);
      std::vector<double> x, y, z;
      for (int i = 0; i < 37; ++i) {  // not a multiple of any vector width
        const LobeSample s = lobe.sample({random.uniform(), random.uniform()});
        x.push_back(s.wi.x());
        y.push_back(s.wi.y());
        z.push_back(s.wi.z());
      }
      std::vector<double> eval(x.size()), pdf(x.size());
      lobe.evalBatch(x, y, z, eval, pdf);
      for (std::size_t i = 0; i < x.size(); ++i) {
        const Vector3d wi(x[i], y[i], z[i]);
        EXPECT_NEAR(eval[i], lobe.eval(wi), 1e-9 * lobe.eval(wi));
        EXPECT_NEAR(pdf[i], lobe.pdf(wi), 1e-9 * lobe.pdf(wi));
      }
    }
  }
}

TEST(GgxLobe, BatchOfSamplesIsTheSameAsSingleOnes) {
  Random random(6);
  for (const GgxAlpha alpha : {GgxAlpha{1.0, 1.0}, GgxAlpha{0.3, 0.02}, GgxAlpha{1e-4, 1e-4}}) {
    for (const double theta : {0.0, 40.0, 89.9, 90.0}) {
      const GgxLobe lobe(direction(theta * kDegree, 0.7), alpha);
      constexpr std::size_t kCount = 101;
      std::array<double, kCount> u0, u1, x, y, z, weight;
      for (std::size_t i = 0; i < kCount; ++i) {
        u0[i] = random.uniform();
        u1[i] = random.uniform();
      }
      lobe.sampleBatch(u0, u1, x, y, z, weight);
      for (std::size_t i = 0; i < kCount; ++i) {
        const LobeSample one = lobe.sample({u0[i], u1[i]});
        // sinCos is good to 1e-13; at grazing view a root of what is nearly 0 makes 3e-7 of it
        EXPECT_NEAR(x[i], one.wi.x(), 1e-6);
        EXPECT_NEAR(y[i], one.wi.y(), 1e-6);
        EXPECT_NEAR(z[i], one.wi.z(), 1e-6);
        EXPECT_NEAR(weight[i], one.weight, 1e-5);
        EXPECT_NEAR(x[i] * x[i] + y[i] * y[i] + z[i] * z[i], 1.0, 1e-12);
      }
    }
  }
}

TEST(SinCos, IsAsGoodAsItSays) {
  for (int i = -1000; i <= 1000; ++i) {
    const double x = kPi * i / 1000.0;
    double sine = 0.0;
    double cosine = 0.0;
    sinCos(x, sine, cosine);
    EXPECT_NEAR(sine, std::sin(x), 1e-13) << x;
    EXPECT_NEAR(cosine, std::cos(x), 1e-13) << x;
  }
}

TEST(GgxLobeDeathTest, RefusesWhatIsNotALobe) {
  EXPECT_DEATH(GgxLobe({0.0, 0.0, 2.0}, {0.5, 0.5}), "GgxLobe: wo");
  EXPECT_DEATH(GgxLobe({0.0, 0.0, -1.0}, {0.5, 0.5}), "GgxLobe: wo");
  EXPECT_DEATH(GgxLobe({0.0, 0.0, 1.0}, {0.0, 0.5}), "alpha = \\(0, 0.5\\)");
}

}  // namespace
}  // namespace ltcfit
