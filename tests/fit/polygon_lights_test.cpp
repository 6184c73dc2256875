#include "fit/polygon_lights.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "fit/lobe_samples.h"
#include "fit/moment_start.h"
#include "ggx/ggx_lobe.h"
#include "ggx/moments.h"
#include "ggx/polygon_integral.h"
#include "ltc/ltc.h"
#include "ltc/polygon.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Case {
  explicit Case(const GgxLobe& l)
      : lobe(l),
        truth(lobe),
        albedo(computeMoments(lobe).albedo),
        near(momentStart(weightedSamples(lobe, 4096, 3))) {}
  PolygonLights lights(const PolygonLightOptions& o) const {
    return makePolygonLights(truth, albedo, near, o);
  }

  GgxLobe lobe;
  ContourIntegrator truth;
  double albedo;
  Matrix3d near;
};

double halfSize(const Quad& q) {
  return 0.5 * std::sqrt((q[1] - q[0]).norm() * (q[3] - q[0]).norm());
}

TEST(PolygonLights, CoverTheHemisphereAllSizesAndTheHorizon) {
  const Case c(GgxLobe(viewDirection(1.2, 0.4), {0.3, 0.1}));
  const PolygonLights family = c.lights({});
  ASSERT_EQ(family.lights.size(), 1024u + 64u);
  EXPECT_LT(family.integralError, 1e-4);
  int cut = 0;
  int behind = 0;
  double smallest = 10.0;
  double largest = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < family.lights.size(); ++i) {
    const IntegratedLight& l = family.lights[i];
    EXPECT_GT(l.weight, 0.0);
    squares += l.weight * l.weight;
    const auto up =
        std::count_if(l.quad.begin(), l.quad.end(), [](const Vector3d& v) { return v.z() > 0.0; });
    if (i >= 1024) {
      EXPECT_EQ(up, 0) << "meant to lie below the horizon";
      EXPECT_EQ(l.integral, 0.0);
      continue;
    }
    if (up < 4) ++cut;
    if ((l.quad[0] + l.quad[2]).x() > 0.0) ++behind;
    smallest = std::min(smallest, halfSize(l.quad));
    largest = std::max(largest, halfSize(l.quad));
    EXPECT_NEAR(l.integral, integrateLobeOverPolygon(c.lobe, l.quad).value / c.albedo, 2e-4);
  }
  EXPECT_GT(cut, 100);
  EXPECT_GT(behind, 100);
  EXPECT_LT(smallest, 0.021);
  EXPECT_GT(largest, 1.4);
  EXPECT_NEAR(squares / static_cast<double>(family.lights.size()), 1.0, 1e-9);
}

TEST(PolygonLights, WeightedMeansAreThoseOfUniformLights) {
  // however the lights are aimed: the ratio of two weighted means of squares stays that of uniform lights,
  // here by 200,000 of them
  for (const auto& [alpha, theta] : {std::pair{0.5, 0.8}, std::pair{0.1, 0.8}, std::pair{0.1, 1.4}}) {
    const Case c(GgxLobe(viewDirection(theta, 0.0), {alpha, alpha}));
    PolygonLightOptions options;
    options.lights = 32768;
    options.sizeExponent = 0.0;
    const PolygonLights family = c.lights(options);
    Matrix3d other = c.near;
    other.col(0) *= 1.3;
    const Ltc a(c.near);
    const Ltc b(other);
    double aimed = 0.0;
    double weights = 0.0;
    for (int i = 0; i < options.lights; ++i) {
      const IntegratedLight& l = family.lights[static_cast<std::size_t>(i)];
      aimed += std::pow(l.weight * (ltcPolygonIntegral(a, l.quad) - ltcPolygonIntegral(b, l.quad)), 2);
      weights += l.weight * l.weight;
    }
    Random random(4);
    double uniform = 0.0;
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) {
      const double z = random.uniform();
      const double phi = 6.283185307179586 * random.uniform();
      const double r = std::sqrt(1.0 - z * z);
      const double size = 0.02 * std::pow(75.0, random.uniform());
      const double aspect = std::exp(0.7 * (2.0 * random.uniform() - 1.0));
      const Quad quad = facingRectangle({r * std::cos(phi), r * std::sin(phi), z}, {0.0, 0.0},
                                        {size * aspect, size / aspect}, 6.283185307179586 * random.uniform());
      uniform += std::pow(ltcPolygonIntegral(a, quad) - ltcPolygonIntegral(b, quad), 2) / n;
    }
    // the density over large lights is that on a plane, not on the sphere: some percent
    EXPECT_NEAR(aimed / weights / uniform, 1.0, 0.12) << alpha << " " << theta;
  }
}

TEST(PolygonLights, AreTheSameForTheSameSeedOnly) {
  const Case c(GgxLobe(viewDirection(0.5, 0.0), {0.2, 0.2}));
  PolygonLightOptions options;
  options.lights = 64;
  const PolygonLights first = c.lights(options);
  const PolygonLights again = c.lights(options);
  options.seed = 2;
  const PolygonLights other = c.lights(options);
  int same = 0;
  for (std::size_t i = 0; i < first.lights.size(); ++i) {
    EXPECT_EQ(first.lights[i].quad, again.lights[i].quad);
    EXPECT_EQ(first.lights[i].integral, again.lights[i].integral);
    same += first.lights[i].quad == other.lights[i].quad ? 1 : 0;
  }
  EXPECT_EQ(same, 0);
}

TEST(PolygonLights, WeightingAndSizeExponentWeigh) {
  const Case c(GgxLobe(viewDirection(0.5, 0.0), {0.2, 0.2}));
  PolygonLightOptions options;
  options.sizeExponent = 0.0;
  const PolygonLights absolute = c.lights(options);
  options.weighting = LightWeighting::kRelative;
  const PolygonLights relative = c.lights(options);
  options.weighting = LightWeighting::kMixed;
  const PolygonLights mixed = c.lights(options);
  options = {};
  options.sizeExponent = 1.0;
  const PolygonLights small = c.lights(options);
  // ratios of weights between a light full of the lobe and one beside it
  std::size_t full = 0;
  std::size_t empty = 0;
  for (std::size_t i = 0; i < 1024; ++i) {
    if (absolute.lights[i].integral > absolute.lights[full].integral) full = i;
    if (absolute.lights[i].integral < absolute.lights[empty].integral) empty = i;
  }
  const auto ratio = [&](const PolygonLights& f) { return f.lights[empty].weight / f.lights[full].weight; };
  EXPECT_GT(ratio(relative) / ratio(absolute), 50.0);
  EXPECT_NEAR(ratio(mixed) / ratio(absolute), std::sqrt(ratio(relative) / ratio(absolute)), 1e-6);
  const double a = halfSize(small.lights[full].quad);
  const double b = halfSize(small.lights[empty].quad);
  EXPECT_NEAR(ratio(small) / ratio(absolute), a / b, 1e-6 * a / b);
  for (const LightWeighting w :
       {LightWeighting::kAbsolute, LightWeighting::kRelative, LightWeighting::kMixed})
    EXPECT_EQ(lightWeightingFromName(lightWeightingName(w)), w);
  EXPECT_THROW(lightWeightingFromName("heavy"), std::invalid_argument);
}

TEST(PolygonLightOptions, AreChecked) {
  std::string error;
  PolygonLightOptions o;
  EXPECT_TRUE(o.isValid(&error));
  o.lights = 15;
  EXPECT_FALSE(o.isValid(&error));
  EXPECT_NE(error.find("15"), std::string::npos);
  o = {};
  o.sizeExponent = std::nan("");
  EXPECT_FALSE(o.isValid(&error));
}

}  // namespace
}  // namespace ltcfit
