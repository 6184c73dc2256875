#include "ggx/contour_integral.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "ggx/ggx_lobe.h"
#include "ggx/moments.h"
#include "ggx/polygon_integral.h"
#include "ggx/random.h"

namespace ltcfit {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Quad = std::array<Vector3d, 4>;

constexpr double kPi = std::numbers::pi;

Quad rectangle(const Vector3d& centre, double halfA, double halfB, double angle) {
  const Vector3d d = centre.normalized();
  const Vector3d helper = std::abs(d.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
  const Vector3d t = helper.cross(d).normalized();
  const Vector3d a = Eigen::AngleAxisd(angle, d) * t;
  const Vector3d x = halfA * a;
  const Vector3d y = halfB * d.cross(a);
  return {d - x - y, d + x - y, d + x + y, d - x + y};
}

// Sizes from 0.02 to 1.5; every other one has the mirror direction near its outline or inside of it.
std::vector<Quad> randomQuads(const GgxLobe& lobe, int count, Random& random) {
  const Vector3d mirror(-lobe.wo().x(), -lobe.wo().y(), lobe.wo().z());
  std::vector<Quad> out;
  for (int i = 0; i < count; ++i) {
    const double size = 0.02 * std::pow(75.0, random.uniform());
    Vector3d centre(random.normal(), random.normal(), std::abs(random.normal()));
    if (i % 2 == 0) centre = mirror + size * centre;
    out.push_back(rectangle(centre, size, size * (0.5 + random.uniform()), 6.3 * random.uniform()));
  }
  return out;
}

// Shares of the lobe in each light, by counting importance samples: slow, but nothing can be missed.
std::vector<double> hitRates(const GgxLobe& lobe, const std::vector<Quad>& quads, int count) {
  std::vector<std::array<Vector3d, 4>> normals;
  for (const Quad& q : quads) {
    normals.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) normals.back()[k] = q[k].cross(q[(k + 1) % 4]);
  }
  const R2Sequence points(5);
  std::vector<double> sums(quads.size(), 0.0);
  double* const sum = sums.data();
  const std::size_t n = quads.size();
#pragma omp parallel for reduction(+ : sum[:n])
  for (int i = 0; i < count; ++i) {
    const LobeSample s = lobe.sample(points(static_cast<std::uint64_t>(i)));
    if (!(s.weight > 0.0)) continue;
    for (std::size_t j = 0; j < n; ++j) {
      const auto& e = normals[j];
      if (s.wi.dot(e[0]) > 0.0 && s.wi.dot(e[1]) > 0.0 && s.wi.dot(e[2]) > 0.0 && s.wi.dot(e[3]) > 0.0)
        sum[j] += s.weight;
    }
  }
  for (double& x : sums) x /= count;
  return sums;
}

GgxLobe randomLobe(int i, Random& random) {
  const double a = std::pow(10.0, -4.0 * random.uniform() * random.uniform());
  const double b = std::max(1e-4, a * std::pow(10.0, -4.0 * random.uniform() * random.uniform()));
  GgxAlpha alpha{a, i % 3 == 0 ? a : b};
  if (i % 2 == 1) std::swap(alpha.x, alpha.y);
  const double theta = i % 6 == 0 ? 0.5 * kPi : 0.5 * kPi * std::sqrt(random.uniform());
  const double phi = i % 5 == 0 ? 0.0 : 0.5 * kPi * random.uniform();
  return GgxLobe(viewDirection(theta, phi), alpha);
}

TEST(ContourIntegrator, IsWithinATenThousandthOfTenMillionSamples) {
  // 10 million quasi-random points give an indicator to some 1e-5
  Random random(21);
  double worst = 0.0;
  for (int i = 0; i < 12; ++i) {
    const GgxLobe lobe = randomLobe(i, random);
    const ContourIntegrator integrator(lobe);
    const std::vector<Quad> quads = randomQuads(lobe, 12, random);
    const std::vector<double> expected = hitRates(lobe, quads, 10'000'000);
    for (std::size_t k = 0; k < quads.size(); ++k) {
      const double difference = std::abs(integrator.integrate(quads[k]).value - expected[k]);
      EXPECT_LT(difference, 1e-4) << lobe.alpha().x << " " << lobe.alpha().y << " z " << lobe.wo().z() << " "
                                  << k;
      worst = std::max(worst, difference);
    }
  }
  std::printf("largest difference from 10 million samples %.1e\n", worst);
}

TEST(ContourIntegrator, MissesNothingOfManyLobes) {
  Random random(22);
  for (int i = 0; i < 240; ++i) {
    const GgxLobe lobe = randomLobe(i, random);
    const ContourIntegrator integrator(lobe);
    const std::vector<Quad> quads = randomQuads(lobe, 16, random);
    const std::vector<double> expected = hitRates(lobe, quads, 1 << 15);
    for (std::size_t k = 0; k < quads.size(); ++k) {
      // what 32,768 points give for an indicator of a long light's edge
      EXPECT_NEAR(integrator.integrate(quads[k]).value, expected[k], 2.5e-3)
          << lobe.alpha().x << " " << lobe.alpha().y << " z " << lobe.wo().z() << " " << k;
    }
  }
}

TEST(ContourIntegrator, SeesNeedlesAtTheHorizon) {
  // 10,000:1 and half cut by the horizon: the outline of a light leaves one end of the projection for the
  // other within a ten-thousandth of an edge, and comes back
  for (const GgxAlpha alpha :
       {GgxAlpha{0.7, 1e-4}, GgxAlpha{1e-4, 0.7}, GgxAlpha{1e-5, 1.0}, GgxAlpha{1e-5, 1e-5}}) {
    for (const double theta : {80.0, 89.99, 90.0}) {
      for (const double phi : {0.0, 5.0, 90.0}) {
        const GgxLobe lobe(viewDirection(theta / 180.0 * kPi, phi / 180.0 * kPi), alpha);
        const ContourIntegrator integrator(lobe);
        Random random(23);
        const std::vector<Quad> quads = randomQuads(lobe, 60, random);
        const std::vector<double> expected = hitRates(lobe, quads, 1 << 15);
        for (std::size_t k = 0; k < quads.size(); ++k) {
          EXPECT_NEAR(integrator.integrate(quads[k]).value, expected[k], 2.5e-3)
              << alpha.x << " " << alpha.y << " theta " << theta << " phi " << phi << " " << k;
        }
      }
    }
  }
}

TEST(ContourIntegrator, AgreesWithAdaptiveCubature) {
  Random random(24);
  for (const double alpha : {1.0, 0.3, 0.05, 0.005}) {
    for (const double theta : {0.0, 0.8, 1.5}) {
      const GgxLobe lobe(viewDirection(theta, 0.0), {alpha, alpha});
      const ContourIntegrator integrator(lobe);
      for (const Quad& quad : randomQuads(lobe, 20, random)) {
        EXPECT_NEAR(integrator.integrate(quad).value, integrateLobeOverPolygon(lobe, quad).value, 1e-4)
            << alpha << " " << theta;
      }
    }
  }
}

TEST(ContourIntegrator, SeesEdgesThatLeaveTheirPlaceAndComeBack) {
  // found by a search with edges along and through the plane of incidence: one whose image is a loop within a
  // ten-thousandth of its length
  const GgxLobe lobe(viewDirection(0.5 * kPi, 0.0), {1.170e-5, 6.084e-2});
  const Quad quad{Vector3d{-0.99992609806243571, 0.94021661294149694, 0.00025193847232067942},
                  Vector3d{-1.0000090625316849, -0.11570731667698898, 0.00025193847232067942},
                  Vector3d{-0.99985310099987068, -0.11570732893096423, 0.61929803297844044},
                  Vector3d{-0.99977013653062141, 0.94021660068752178, 0.61929803297844044}};
  EXPECT_NEAR(ContourIntegrator(lobe).integrate(quad).value, hitRates(lobe, {quad}, 1 << 20)[0], 1e-4);
  // and a small search of that kind
  Random random(26);
  int checked = 0;
  for (int i = 0; i < 150; ++i) {
    const GgxAlpha alpha{std::pow(10.0, -4.0 * random.uniform()), std::pow(10.0, -4.0 * random.uniform())};
    const double theta = i % 8 == 0 ? 0.5 * kPi : 0.5 * kPi - std::pow(10.0, -1.0 - 4.0 * random.uniform());
    const GgxLobe l(viewDirection(theta, i % 2 == 0 ? 0.0 : 0.5 * kPi), alpha);
    const ContourIntegrator integrator(l);
    const Vector3d mirror(-l.wo().x(), -l.wo().y(), l.wo().z());
    std::vector<Quad> quads;
    for (int k = 0; k < 12; ++k) {
      const double size = 0.02 * std::pow(75.0, random.uniform());
      // the mirror direction on an edge, or off it by some part of a millionth to a tenth
      const Quad q = rectangle(mirror, size, size, k % 3 == 0 ? 6.3 * random.uniform() : 0.5 * kPi * (k % 2));
      const double aside = 1.0 + (k % 2 == 0 ? 0.0 : std::pow(10.0, -6.0 * random.uniform()));
      const Vector3d x = 0.5 * (q[1] - q[0]) * (2.0 * random.uniform() - 1.0);
      const Vector3d move = x + aside * 0.5 * (q[3] - q[0]);
      quads.push_back({q[0] + move, q[1] + move, q[2] + move, q[3] + move});
    }
    const std::vector<double> expected = hitRates(l, quads, 1 << 15);
    for (std::size_t k = 0; k < quads.size(); ++k) {
      const double value = integrator.integrate(quads[k]).value;
      ++checked;
      if (std::abs(value - expected[k]) < 8e-4) continue;  // more samples only where it matters
      EXPECT_NEAR(value, hitRates(l, {quads[k]}, 1 << 21)[0], 5e-4)
          << alpha.x << " " << alpha.y << " " << theta;
    }
  }
  EXPECT_EQ(checked, 1800);
}

TEST(ContourIntegrator, WallsThroughTheNadirAndVerticesOfAnyLength) {
  const GgxLobe lobe(viewDirection(0.8, 0.0), {0.5, 0.5});
  const ContourIntegrator integrator(lobe);
  const double hemisphere = integrator.hemisphere();
  const std::vector<std::vector<Vector3d>> polygons{
      {{0.2, -8, -6}, {-3, -8, 10}, {-3, 8, 10}, {0.2, 8, -6}},
      {{-1, -1, 1}, {0.1, 0, -1}, {-1, 1, 1}},
      {{-1, -1, 1}, {0, 0, -1}, {-1, 1, 1}},
      {{-1e-8, -2e-8, 1e-8}, {-1e8, -0.5e8, 0.7e8}, {-1, 1.3, 2}}};
  for (const auto& polygon : polygons) {
    // the cubature wants one plane, and planar triangles are
    double expected = 0.0;
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      const std::array<Vector3d, 3> triangle{polygon[0].normalized(), polygon[k - 1].normalized(),
                                             polygon[k].normalized()};
      expected += integrateLobeOverPolygon(lobe, triangle).value;
    }
    EXPECT_NEAR(integrator.integrate(polygon).value, expected, 1e-4) << polygon[0].transpose();
    EXPECT_LE(std::abs(integrator.integrate(polygon).value), hemisphere + 1e-4);
  }
}

TEST(ContourIntegrator, NearGrazingRoughLobesKeepTheirAlbedo) {
  // the horizon then turns from the rim to the middle within wo.z radians
  for (const double alpha : {0.5, 0.8, 0.97}) {
    for (const double z : {1e-5, 1e-4, 1e-3, 1e-2}) {
      const GgxLobe lobe(viewDirection(std::acos(z), 0.0), {alpha, alpha});
      EXPECT_NEAR(ContourIntegrator(lobe).hemisphere(), computeMoments(lobe).albedo, 1e-4)
          << alpha << " " << z;
    }
  }
}

TEST(ContourIntegratorDeath, OptionsOutOfRange) {
  const GgxLobe lobe(viewDirection(0.8, 0.0), {0.5, 0.5});
  EXPECT_DEATH(ContourIntegrator(lobe, {8, 32, 1e-5}), "azimuths = 8");
  EXPECT_DEATH(ContourIntegrator(lobe, {64, 2, 1e-5}), "radii = 2");
  EXPECT_DEATH(ContourIntegrator(lobe, {64, 32, std::nan("")}), "tolerance");
}

TEST(ContourIntegrator, HemisphereIsTheAlbedoAndTellsACoarseTable) {
  Random random(25);
  double fine = 0.0;
  double coarse = 0.0;
  for (int i = 0; i < 60; ++i) {
    const GgxLobe lobe = randomLobe(i, random);
    const double albedo = computeMoments(lobe).albedo;
    fine = std::max(fine, std::abs(ContourIntegrator(lobe).hemisphere() - albedo));
    coarse = std::max(coarse, std::abs(ContourIntegrator(lobe, {16, 4, 1e-5}).hemisphere() - albedo));
  }
  EXPECT_LT(fine, 1e-4);
  EXPECT_GT(coarse, 1e-3);
}

TEST(ContourIntegrator, SignIsTheWindingAndPartsAddUp) {
  const GgxLobe lobe(viewDirection(0.9, 0.3), {0.4, 0.1});
  const ContourIntegrator integrator(lobe);
  // a star about the mirror direction, not convex, cut into triangles from a point off its middle
  const Vector3d centre =
      rectangle(Vector3d(-lobe.wo().x(), -lobe.wo().y(), lobe.wo().z()), 0.1, 0.1, 0.0)[0];
  const Quad frame = rectangle(centre, 1.0, 1.0, 0.4);
  const Vector3d x = 0.5 * (frame[1] - frame[0]);
  const Vector3d y = 0.5 * (frame[3] - frame[0]);
  std::vector<Vector3d> star;
  for (int k = 0; k < 10; ++k) {
    const double r = k % 2 == 0 ? 0.8 : 0.25;
    star.push_back(centre.normalized() + r * std::cos(0.2 * kPi * k) * x + r * std::sin(0.2 * kPi * k) * y);
  }
  const double whole = integrator.integrate(star).value;
  EXPECT_GT(whole, 0.1);
  double parts = 0.0;
  for (std::size_t k = 0; k < star.size(); ++k)
    parts += integrator.integrate(std::array<Vector3d, 3>{centre, star[k], star[(k + 1) % 10]}).value;
  EXPECT_NEAR(whole, parts, 5e-5);
  std::vector<Vector3d> reversed(star.rbegin(), star.rend());
  EXPECT_NEAR(integrator.integrate(reversed).value, -whole, 1e-6);
}

TEST(ContourIntegrator, NothingComesFromBelowTheHorizon) {
  const GgxLobe lobe(viewDirection(1.4, 0.0), {0.3, 0.3});
  const ContourIntegrator integrator(lobe);
  EXPECT_EQ(integrator.integrate(rectangle({0.5, 0.2, -0.6}, 0.3, 0.3, 0.2)).value, 0.0);
  EXPECT_EQ(integrator.integrate(std::vector<Vector3d>{}).value, 0.0);
  // a light that sinks: continuous, down to nothing
  double last = integrator.integrate(rectangle({-1.0, 0.0, 0.4}, 0.3, 0.3, 0.3)).value;
  EXPECT_GT(last, 0.1);
  for (int i = 1; i <= 200; ++i) {
    const double value = integrator.integrate(rectangle({-1.0, 0.0, 0.4 - 0.004 * i}, 0.3, 0.3, 0.3)).value;
    EXPECT_NEAR(value, last, 0.02) << i;
    last = value;
  }
  EXPECT_EQ(last, 0.0);
}

}  // namespace
}  // namespace ltcfit
