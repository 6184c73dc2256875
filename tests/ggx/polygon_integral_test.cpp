#include "ggx/polygon_integral.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "ggx/ggx_lobe.h"
#include "ggx/moments.h"
#include "ggx/random.h"

namespace ltcfit {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

std::array<Vector3d, 4> rectangle(const Vector3d& centre, double halfA, double halfB) {
  const Vector3d d = centre.normalized();
  const Vector3d helper = std::abs(d.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
  const Vector3d a = helper.cross(d).normalized() * halfA;
  const Vector3d b = d.cross(a.normalized()) * halfB;
  return {centre - a - b, centre + a - b, centre + a + b, centre - a + b};
}

// Counts the importance samples that hit: an indicator, so it converges slowly, but nothing can be missed.
double hitRate(const GgxLobe& lobe, const std::array<Vector3d, 4>& quad) {
  constexpr int kCount = 1 << 19;
  const R2Sequence points(5);
  double sum = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const LobeSample s = lobe.sample(points(static_cast<std::uint64_t>(i)));
    bool inside = true;
    for (std::size_t k = 0; k < 4; ++k) inside = inside && s.wi.dot(quad[k].cross(quad[(k + 1) % 4])) > 0.0;
    if (inside) sum += s.weight;
  }
  return sum / kCount;
}

TEST(PolygonIntegral, AgreesWithSampling) {
  Random random(11);
  for (const GgxAlpha alpha :
       {GgxAlpha{1.0, 1.0}, GgxAlpha{0.1, 0.1}, GgxAlpha{1e-3, 1e-3}, GgxAlpha{0.5, 0.005}}) {
    for (double theta : {0.0, 50.0, 85.0, 89.9, 90.0}) {
      const GgxLobe lobe(viewDirection(theta * kPi / 180.0, 0.4), alpha);
      for (double size : {0.05, 0.25, 0.8}) {
        // half of them around the mirror direction, through edges and horizon as it comes
        const Vector3d mirror(-lobe.wo().x(), -lobe.wo().y(), lobe.wo().z());
        Vector3d centre(random.normal(), random.normal(), std::abs(random.normal()));
        if (random.uniform() < 0.5) centre = mirror + 0.5 * size * centre;
        centre.normalize();
        const auto quad = rectangle(centre, size, 0.6 * size);
        const PolygonIntegral got = integrateLobeOverPolygon(lobe, quad);
        // 3e-4: what half a million quasi-random points give for an indicator
        EXPECT_NEAR(got.value, hitRate(lobe, quad), 3e-4)
            << alpha.x << " " << alpha.y << " " << theta << " " << size;
        EXPECT_LT(got.error, 2e-4);
      }
    }
  }
}

TEST(PolygonIntegral, TheWholeHemisphereIsTheAlbedo) {
  // a pyramid whose four faces cover it
  const std::array<Vector3d, 4> ring{Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(-1, 0, 0),
                                     Vector3d(0, -1, 0)};
  for (double alpha : {1e-4, 0.05, 0.7}) {
    const GgxLobe lobe(viewDirection(1.1, 0.3), {alpha, alpha});
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      sum += integrateLobeOverPolygon(lobe,
                                      std::array<Vector3d, 3>{Vector3d::UnitZ(), ring[k], ring[(k + 1) % 4]})
                 .value;
    }
    EXPECT_NEAR(sum, computeMoments(lobe).albedo, 2e-5) << alpha;
  }
}

TEST(PolygonIntegral, ASharpLobeInsideALargeLightIsFound) {
  for (double alpha : {1e-2, 1e-3, 1e-4, 1e-5}) {
    const GgxLobe lobe(viewDirection(0.7, 0.0), {alpha, alpha});
    // off-centre, so that no point of a coarse rule falls on the peak by luck
    const Vector3d mirror(-lobe.wo().x(), -lobe.wo().y(), lobe.wo().z());
    const Vector3d centre = (mirror + Vector3d(0.13, -0.21, 0.05)).normalized();
    EXPECT_GT(integrateLobeOverPolygon(lobe, rectangle(centre, 0.8, 0.8)).value, 0.99) << alpha;
  }
}

TEST(PolygonIntegral, WindingGivesTheSign) {
  const GgxLobe lobe(viewDirection(0.5, 0.0), {0.3, 0.3});
  const auto quad = rectangle({-0.3, 0.1, 0.9}, 0.3, 0.3);
  const std::array<Vector3d, 4> reversed{quad[3], quad[2], quad[1], quad[0]};
  const double value = integrateLobeOverPolygon(lobe, quad).value;
  EXPECT_GT(value, 0.01);
  EXPECT_NEAR(integrateLobeOverPolygon(lobe, reversed).value, -value, 1e-6);
  EXPECT_EQ(integrateLobeOverPolygon(lobe, std::span(quad).first(2)).value, 0.0);
}

TEST(PolygonIntegral, PolygonsThatAreNotConvex) {
  // an L, whole and cut into two rectangles
  const GgxLobe lobe(viewDirection(0.9, 0.0), {0.2, 0.2});
  const auto at = [](double x, double y) { return Vector3d(x - 1.2, y, 1.0); };
  const std::array<Vector3d, 6> whole{at(0, 0), at(1, 0), at(1, 0.4), at(0.4, 0.4), at(0.4, 1), at(0, 1)};
  const std::array<Vector3d, 4> a{at(0, 0), at(1, 0), at(1, 0.4), at(0, 0.4)};
  const std::array<Vector3d, 4> b{at(0, 0.4), at(0.4, 0.4), at(0.4, 1), at(0, 1)};
  EXPECT_NEAR(integrateLobeOverPolygon(lobe, whole).value,
              integrateLobeOverPolygon(lobe, a).value + integrateLobeOverPolygon(lobe, b).value, 1e-5);
}

TEST(PolygonIntegral, ALightBelowTheHorizonGivesNothing) {
  const GgxLobe lobe(viewDirection(1.2, 0.0), {0.5, 0.5});
  EXPECT_EQ(integrateLobeOverPolygon(lobe, rectangle({0.5, 0.2, -0.9}, 0.3, 0.3)).value, 0.0);
}

}  // namespace
}  // namespace ltcfit
