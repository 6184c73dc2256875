// Every metric against a known answer, and against an input that it must not like.
#include "report/metrics.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "fit/isotropic_family.h"
#include "ggx/ggx_lobe.h"
#include "ltc/polygon.h"
#include "tests/support/ltc_lobe.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d narrow(const Vector3d& direction, double aperture) {
  return frameAbout(direction) * Vector3d(aperture, aperture, 1.0).asDiagonal();
}

TEST(Metrics, APerfectFitIsZero) {
  Matrix3d m;
  m << 0.5, 0, -0.4, 0, 0.4, 0, 0, 0, 1;  // row 2 is e_z: nothing below the horizon
  const test::LtcLobe lobe(m, 0.8);
  const EntryMetrics e = MetricTarget(lobe, {}).evaluate(Ltc(m));
  EXPECT_LT(e.get(Metric::kSw1), 2e-3);  // two point sets of 4096 for the same distribution
  EXPECT_LT(e.get(Metric::kForm), 1e-5);
  EXPECT_LT(e.get(Metric::kLightS), 1e-5);
  EXPECT_LT(e.get(Metric::kLightM), 1e-5);
  EXPECT_LT(e.get(Metric::kLightL), 1e-5);
  EXPECT_LT(e.get(Metric::kTv), 1e-6);
  EXPECT_LT(e.get(Metric::kL3), 1e-6);
  EXPECT_LT(e.get(Metric::kL3Cost), 1e-18);
  EXPECT_EQ(e.get(Metric::kBelow), 0.0);
}

TEST(Metrics, Sw1OfTwoNarrowLobesIsHalfTheirDistance) {
  // projected on w the two differ by |w.d|, whose mean over the sphere is |d| / 2
  const Vector3d a(-0.3, 0.0, 0.9539392014169457);
  const Vector3d b(-0.6, 0.0, 0.8);
  const test::LtcLobe lobe(narrow(a, 1e-3));
  MetricOptions options;
  options.directions = 512;
  const EntryMetrics e = MetricTarget(lobe, options).evaluate(Ltc(narrow(b, 1e-3)));
  EXPECT_NEAR(e.get(Metric::kSw1), 0.5 * (a - b).norm(), 2e-3);
  EXPECT_NEAR(e.get(Metric::kTv), 1.0, 1e-2);  // hardly any overlap
  EXPECT_GT(e.get(Metric::kSw1Rel), 20.0);     // many widths apart
}

TEST(Metrics, Sw1RelIsSw1OverSpread) {
  const GgxLobe lobe(viewDirection(0.8, 0.0), {0.3, 0.3});
  const MetricTarget target(lobe, {});
  const EntryMetrics e = target.evaluate(Ltc(Matrix3d::Identity()));
  EXPECT_DOUBLE_EQ(e.get(Metric::kSw1Rel), e.get(Metric::kSw1) / target.moments().spread);
  EXPECT_DOUBLE_EQ(target.moments().spread, computeMoments(lobe).spread);
  EXPECT_DOUBLE_EQ(target.sw1(Ltc(Matrix3d::Identity())), e.get(Metric::kSw1));
}

TEST(Metrics, TvAndL3OfUnlikeCosines) {
  // g = max(0, z) / pi, f = max(0, -x) / pi. TV = 1 - integral of min(f, g). Of the lune x < 0 < z, min is z
  // on the half next to the horizon and -x on the other; the irradiance of the lower half is (1 - cos 45) /
  // 2, and so is that of the upper half under -x.
  const test::LtcLobe lobe(Matrix3d::Identity());
  const Matrix3d turned = Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vector3d::UnitY()).toRotationMatrix();
  MetricOptions options;
  options.samples = 1 << 15;
  const EntryMetrics e = MetricTarget(lobe, options).evaluate(Ltc(turned));
  EXPECT_NEAR(e.get(Metric::kTv), 1.0 / std::numbers::sqrt2, 2e-3);
  EXPECT_NEAR(e.get(Metric::kBelow), 0.5, 1e-12);
  // brute force for L3
  double cube = 0.0;
  const int n = 800;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < 2 * n; ++j) {
      const double z = 2.0 * (i + 0.5) / n - 1.0;
      const double phi = std::numbers::pi * (j + 0.5) / n;
      const double x = std::sqrt(1.0 - z * z) * std::cos(phi);
      cube += std::pow(std::abs(std::max(0.0, z) - std::max(0.0, -x)) / std::numbers::pi, 3);
    }
  }
  cube *= 4.0 * std::numbers::pi / (2.0 * n * n);
  EXPECT_NEAR(e.get(Metric::kL3) / std::cbrt(cube), 1.0, 5e-3);
  EXPECT_NEAR(e.get(Metric::kL3Cost) / cube, 1.0, 1.5e-2);
}

TEST(Metrics, L3CostCarriesTheAlbedo) {
  const test::LtcLobe bright(Matrix3d::Identity(), 1.0);
  const test::LtcLobe dim(Matrix3d::Identity(), 0.5);
  const Ltc other(narrow({-0.5, 0, 0.8}, 0.6));
  const EntryMetrics a = MetricTarget(bright, {}).evaluate(other);
  const EntryMetrics b = MetricTarget(dim, {}).evaluate(other);
  EXPECT_NEAR(b.get(Metric::kL3) / a.get(Metric::kL3), 1.0, 1e-6);  // of the normalised lobe
  EXPECT_NEAR(b.get(Metric::kL3Cost) / a.get(Metric::kL3Cost), 0.125, 1e-6);
  EXPECT_NEAR(b.get(Metric::kLightM) / a.get(Metric::kLightM), 0.5, 1e-5);
  EXPECT_NEAR(b.get(Metric::kForm) / a.get(Metric::kForm), 1.0, 1e-5);
}

TEST(Metrics, LightsSeeALobeThatIsMissing) {
  // target the cosine, model a needle that hardly any light covers: the error is the light's own form factor,
  // RMS
  const test::LtcLobe lobe(Matrix3d::Identity());
  MetricOptions options;
  options.lights = 256;
  const EntryMetrics e = MetricTarget(lobe, options).evaluate(Ltc(narrow({1, 0, 0.01}, 1e-6)));
  Random random(mixSeed(options.seed, 9));
  const LobeMoments moments = computeMoments(lobe);
  for (int i = 0; i < options.quads; ++i) randomFormQuad(moments, random);
  double sum = 0.0;
  for (int i = 0; i < options.lights; ++i) {
    const double factor = polygonIrradiance(randomLight(kLightSizes[0], random));
    sum += factor * factor;
  }
  EXPECT_NEAR(e.get(Metric::kLightS) / std::sqrt(sum / options.lights), 1.0, 1e-3);
  EXPECT_GT(e.get(Metric::kLightL), e.get(Metric::kLightM));
  EXPECT_GT(e.get(Metric::kLightM), e.get(Metric::kLightS));
}

TEST(Metrics, FormSeesAShift) {
  const Vector3d a(-0.3, 0.0, 0.95);
  const test::LtcLobe lobe(narrow(a.normalized(), 0.05));
  const MetricTarget target(lobe, {});
  const double near =
      target.evaluate(Ltc(narrow((a + Vector3d(0.005, 0, 0)).normalized(), 0.05))).get(Metric::kForm);
  const double far =
      target.evaluate(Ltc(narrow((a + Vector3d(0.2, 0, 0)).normalized(), 0.05))).get(Metric::kForm);
  EXPECT_GT(near, 1e-3);
  EXPECT_GT(far, 10.0 * near);
  EXPECT_LE(far, 1.0);
}

TEST(Metrics, EntryErrors) {
  TableEntry entry;
  entry.m = narrow({-0.6, 0, 0.8}, 0.01);
  entry.mInv = entry.m.inverse();
  entry.norm = 0.91;
  LobeMoments moments;
  moments.albedo = 0.9;
  moments.fresnel = 0.1;
  EntryMetrics out;
  addEntryErrors(entry, MatrixStorage::kM, moments, out);
  EXPECT_NEAR(out.get(Metric::kAlbedoError), 0.01, 1e-12);
  EXPECT_FALSE(out.present[static_cast<std::size_t>(Metric::kFresnelError)]);  // no such channel: no figure
  EXPECT_TRUE(out.present[static_cast<std::size_t>(Metric::kDetError)]);
  EXPECT_LT(out.get(Metric::kDetError), 1e-5);
  entry.norm = 0.9;
  entry.fresnel = 0.07;
  EntryMetrics other;
  addEntryErrors(entry, MatrixStorage::kM, moments, other);
  EXPECT_EQ(other.get(Metric::kAlbedoError), 0.0);
  EXPECT_NEAR(other.get(Metric::kFresnelError), 0.03, 1e-12);
  // a matrix whose columns nearly coincide loses its determinant to float32
  entry.m << 1, 0, 1, 0, 1, 0, 1, 0, 1.0 + 1e-6;
  entry.mInv = entry.m.inverse();
  EntryMetrics bad;
  addEntryErrors(entry, MatrixStorage::kM, moments, bad);
  EXPECT_GT(bad.get(Metric::kDetError), 1e-3);
}

TEST(Metrics, SeedsMoveTheFiguresALittle) {
  const GgxLobe lobe(viewDirection(1.2, 0.0), {0.3, 0.3});
  const Ltc ltc(narrow({-0.6, 0, 0.8}, 0.4));
  MetricOptions options;
  const EntryMetrics a = MetricTarget(lobe, options).evaluate(ltc);
  options.seed = 2;
  const EntryMetrics b = MetricTarget(lobe, options).evaluate(ltc);
  EXPECT_NE(a.get(Metric::kSw1), b.get(Metric::kSw1));
  EXPECT_NEAR(a.get(Metric::kSw1) / b.get(Metric::kSw1), 1.0, 0.1);
  EXPECT_NEAR(a.get(Metric::kTv) / b.get(Metric::kTv), 1.0, 0.03);
}

}  // namespace
}  // namespace ltcfit
