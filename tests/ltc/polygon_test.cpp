#include "ltc/polygon.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <vector>

#include "ggx/random.h"
#include "ltc/sphere.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

// A planar polygon: 2D outline on the plane with this centre and axes. Star-shaped about the centre, so
// simple, and not convex where the radii say so.
struct PlanarPolygon {
  Vector3d centre, a, b;
  std::vector<Vector2d> outline;

  std::vector<Vector3d> vertices() const {
    std::vector<Vector3d> out;
    for (const Vector2d& p : outline) out.push_back(centre + p.x() * a + p.y() * b);
    return out;
  }
  // Whether the ray from the origin along w hits it: crossing number on the plane.
  bool covers(const Vector3d& w) const {
    const Vector3d n = a.cross(b);
    const double t = centre.dot(n) / w.dot(n);
    if (!(t > 0.0)) return false;
    const Vector3d d = t * w - centre;
    const Vector2d p(d.dot(a) / a.squaredNorm(), d.dot(b) / b.squaredNorm());
    bool inside = false;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
      const Vector2d& u = outline[i];
      const Vector2d& v = outline[j];
      if ((u.y() > p.y()) != (v.y() > p.y()) &&
          p.x() < (v.x() - u.x()) * (p.y() - u.y()) / (v.y() - u.y()) + u.x()) {
        inside = !inside;
      }
    }
    return inside;
  }
};

Vector3d randomDirection(Random& random) {
  return Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

PlanarPolygon randomPolygon(Random& random) {
  PlanarPolygon out;
  const Vector3d n = randomDirection(random);
  out.centre = randomDirection(random) * (0.3 + random.uniform());
  if (std::abs(out.centre.dot(n)) < 0.05) out.centre += 0.1 * n;  // not through the origin
  out.a = n.unitOrthogonal();
  out.b = n.cross(out.a);
  const int count = 3 + static_cast<int>(8.0 * random.uniform());
  const double size = std::exp(1.2 * random.normal());
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * kPi * (i + 0.8 * random.uniform()) / count;
    const double radius = size * (0.15 + random.uniform());  // uneven: mostly not convex
    out.outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return out;
}

bool isConvex(const std::vector<Vector2d>& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vector2d u = p[(i + 1) % p.size()] - p[i];
    const Vector2d v = p[(i + 2) % p.size()] - p[(i + 1) % p.size()];
    if (u.x() * v.y() - u.y() * v.x() < 0.0) return false;
  }
  return true;
}

TEST(PolygonIrradiance, AgreesWithMonteCarloOnAThousandPolygons) {
  Random random(1);
  constexpr int kPolygons = 1000, kSamples = 20000;
  std::vector<Vector3d> cosine;
  for (int i = 0; i < kSamples; ++i) cosine.push_back(sampleCosine({random.uniform(), random.uniform()}));
  int clipped = 0, notConvex = 0, visible = 0;
  for (int k = 0; k < kPolygons; ++k) {
    const PlanarPolygon polygon = randomPolygon(random);
    const std::vector<Vector3d> v = polygon.vertices();
    int up = 0;
    for (const Vector3d& p : v) up += p.z() > 0.0 ? 1 : 0;
    if (up > 0 && up < static_cast<int>(v.size())) ++clipped;
    if (!isConvex(polygon.outline)) ++notConvex;
    int hits = 0;
    for (const Vector3d& w : cosine) hits += polygon.covers(w) ? 1 : 0;
    const double got = std::abs(polygonIrradiance(v));
    const double standardError = std::sqrt(std::max(got * (1.0 - got), 1.0 / kSamples) / kSamples);
    EXPECT_NEAR(static_cast<double>(hits) / kSamples, got, 4.0 * standardError) << "polygon " << k;
    if (hits > 0) ++visible;
  }
  // the set is what it says
  EXPECT_GT(clipped, 200);
  EXPECT_GT(notConvex, 500);
  EXPECT_GT(visible, 500);
}

TEST(PolygonIrradiance, SignIsTheWinding) {
  const std::vector<Vector3d> up{
      {1, 0, 1}, {0, 1, 1}, {-1, 0, 1}, {0, -1, 1}};  // counterclockwise from above
  const std::vector<Vector3d> down(up.rbegin(), up.rend());
  EXPECT_GT(polygonIrradiance(up), 0.3);
  EXPECT_DOUBLE_EQ(polygonIrradiance(down), -polygonIrradiance(up));
}

TEST(PolygonIrradiance, KnownValues) {
  // a square [-1, 1]^2 at height 1: (4 / pi) (1 / sqrt 2) atan(1 / sqrt 2), the textbook factor of parallel
  // plates
  const std::vector<Vector3d> square{{1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}, {1, -1, 1}};
  EXPECT_NEAR(polygonIrradiance(square),
              4.0 / kPi / std::numbers::sqrt2 * std::atan(1.0 / std::numbers::sqrt2), 1e-14);
  // the whole sky
  const std::vector<Vector3d> sky{{1e9, 1e9, 1}, {-1e9, 1e9, 1}, {-1e9, -1e9, 1}, {1e9, -1e9, 1}};
  EXPECT_NEAR(polygonIrradiance(sky), 1.0, 1e-8);
  // a wall through the horizon, half of the sky
  const std::vector<Vector3d> wall{{1, 1e9, -1e9}, {1, -1e9, -1e9}, {1, -1e9, 1e9}, {1, 1e9, 1e9}};
  EXPECT_NEAR(std::abs(polygonIrradiance(wall)), 0.5, 1e-8);
}

TEST(PolygonIrradiance, NothingToSee) {
  const std::vector<Vector3d> below{{1, 0, -1}, {0, 1, -1}, {-1, 0, -1}};
  EXPECT_EQ(polygonIrradiance(below), 0.0);
  EXPECT_EQ(polygonIrradiance({}), 0.0);
  EXPECT_EQ(polygonIrradiance(std::span(below).first(2)), 0.0);
  const std::vector<Vector3d> flat{{1, 0, 0}, {0, 1, 0}, {-1, -1, 0}};  // in the horizon plane
  EXPECT_EQ(polygonIrradiance(flat), 0.0);
}

TEST(PolygonIrradiance, IsContinuousWhenAVertexCrossesTheHorizon) {
  const auto at = [](double z) {
    return polygonIrradiance(std::vector<Vector3d>{{1, -0.5, 0.4}, {1, 0.7, 0.3}, {1.2, 0.1, z}});
  };
  EXPECT_NEAR(at(1e-12), at(-1e-12), 1e-11);
  EXPECT_NEAR(at(0.0), at(1e-12), 1e-11);
}

TEST(PolygonIrradiance, DegenerateEdges) {
  const std::vector<Vector3d> triangle{{1, 0, 1}, {0, 1, 1}, {-1, -1, 1}};
  const double value = polygonIrradiance(triangle);
  // repeated and nearly repeated vertices, vertices along an edge
  EXPECT_NEAR(polygonIrradiance(std::vector<Vector3d>{{1, 0, 1}, {1, 0, 1}, {0, 1, 1}, {-1, -1, 1}}), value,
              1e-15);
  EXPECT_NEAR(polygonIrradiance(std::vector<Vector3d>{{1, 0, 1}, {1, 1e-13, 1}, {0, 1, 1}, {-1, -1, 1}}),
              value, 1e-12);
  EXPECT_NEAR(polygonIrradiance(std::vector<Vector3d>{{1, 0, 1}, {0.5, 0.5, 1}, {0, 1, 1}, {-1, -1, 1}}),
              value, 1e-15);
  // a tiny polygon: cosine times solid angle over pi
  const double s = 1e-6;
  const std::vector<Vector3d> tiny{{s, s, 1}, {-s, s, 1}, {-s, -s, 1}, {s, -s, 1}};
  EXPECT_NEAR(polygonIrradiance(tiny) / (4.0 * s * s / kPi), 1.0, 1e-4);  // 1e-16 / s^2 of cancellation
  // an edge through the origin
  EXPECT_TRUE(std::isfinite(polygonIrradiance(std::vector<Vector3d>{{1, 0, 0.5}, {-1, 0, -0.5}, {0, 1, 1}})));
}

TEST(LtcPolygonIntegral, AgreesWithMonteCarlo) {
  Random random(2);
  for (int k = 0; k < 50; ++k) {
    Matrix3d m;
    do {
      for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = random.normal();
    } while (std::abs(m.determinant()) < 0.2);
    const Ltc ltc(m);
    const PlanarPolygon polygon = randomPolygon(random);
    const int n = 20000;
    int hits = 0;
    for (int i = 0; i < n; ++i)
      hits += polygon.covers(ltc.sample({random.uniform(), random.uniform()})) ? 1 : 0;
    const double got = std::abs(ltcPolygonIntegral(ltc, polygon.vertices()));
    EXPECT_NEAR(static_cast<double>(hits) / n, got, 4.0 * std::sqrt(std::max(got * (1 - got), 1.0 / n) / n))
        << k;
  }
}

TEST(LtcPolygonIntegral, EquivalentMatricesGiveTheSameSign) {
  Matrix3d m;
  m << 0.5, 0.1, -0.4, 0.0, 0.3, 0.1, 0.2, 0.0, 0.9;
  const Matrix3d flipped = m * Vector3d(-1, 1, 1).asDiagonal();
  const std::vector<Vector3d> light{{1, 0, 1}, {0, 1, 1}, {-1, 0, 1}, {0, -1, 1}};
  EXPECT_GT(ltcPolygonIntegral(Ltc(m), light), 0.1);
  EXPECT_NEAR(ltcPolygonIntegral(Ltc(flipped), light), ltcPolygonIntegral(Ltc(m), light), 1e-14);
}

// Largest deviation of the gradient from central differences over M (I + h E_rc), in units of the larger of
// the two.
double gradientError(const Matrix3d& m, const std::vector<Vector3d>& polygon, double h, double spoil = 0.0) {
  Matrix3d gradient;
  ltcPolygonIntegral(Ltc(m), polygon, &gradient);
  gradient(0, 2) += spoil * gradient.norm();
  Matrix3d differences;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      const auto at = [&](double step) {
        Matrix3d change = Matrix3d::Identity();
        change(r, c) += step;
        return ltcPolygonIntegral(Ltc(m * change), polygon);
      };
      differences(r, c) = (at(h) - at(-h)) / (2.0 * h);
    }
  }
  return (gradient - differences).norm() / std::max({gradient.norm(), differences.norm(), 1e-6});
}

TEST(LtcPolygonIntegral, GradientAgreesWithDifferencesAndAWrongOneDoesNot) {
  Random random(31);
  int clipped = 0;
  for (int i = 0; i < 500; ++i) {
    Matrix3d m = Eigen::AngleAxisd(3.0 * random.uniform(),
                                   Vector3d(random.normal(), random.normal(), 0.3).normalized())
                     .toRotationMatrix();
    const double width = std::pow(10.0, -3.0 * random.uniform());
    m.col(0) *= width;
    m.col(1) *= width * (0.3 + random.uniform());
    if (i % 7 == 0) m.col(1) *= -1.0;
    // in units of the lobe's width about its axis, so that the light matters
    std::vector<Vector3d> polygon;
    const Vector3d centre(random.normal(), random.normal(), 0.2 + random.uniform());
    for (int k = 0; k < 5; ++k) {
      const double angle = 0.4 * kPi * k;
      const double radius = k % 2 == 0 ? 1.0 : 0.5;
      polygon.push_back(
          m * (centre + radius * Vector3d(std::cos(angle), std::sin(angle), 0.4 * std::cos(angle))));
    }
    const Ltc ltc(m);
    int up = 0;
    for (const Vector3d& p : polygon) up += (ltc.mInv() * p).z() > 0.0 ? 1 : 0;
    if (up > 0 && up < 5) ++clipped;
    // a step of 1e-5 leaves 1e-9 of truncation and 1e-11 of rounding; a vertex at the horizon makes a kink
    EXPECT_LT(gradientError(m, polygon, 1e-5), 1e-5) << i;
    EXPECT_GT(gradientError(m, polygon, 1e-5, 1e-3), 1e-4) << "a wrong gradient";
  }
  EXPECT_GT(clipped, 30);
}

TEST(LtcPolygonIntegral, GradientIsContinuousWhereAVertexCrossesTheHorizon) {
  const Matrix3d m = Matrix3d::Identity();
  Matrix3d last;
  double value = 0.0;
  for (int i = -100; i <= 100; ++i) {
    const std::vector<Vector3d> polygon{{0.5, -0.4, 0.6}, {0.9, 0.3, 1e-4 * i}, {0.4, 0.5, 0.7}};
    Matrix3d gradient;
    const double now = ltcPolygonIntegral(Ltc(m), polygon, &gradient);
    if (i > -100) {
      EXPECT_LT((gradient - last).norm(), 5e-4) << i;
      EXPECT_NEAR(now, value, 1e-4);
    }
    last = gradient;
    value = now;
  }
}

TEST(LtcPolygonIntegral, GradientIsFiniteForHardEdges) {
  Matrix3d gradient;
  const Ltc ltc(Matrix3d::Identity());
  // edges that nearly vanish, that coincide, and one that spans nearly pi; differences where they can be
  // taken
  const std::vector<Vector3d> tiny{
      {0.1, 0.2, 1.0}, {0.1 + 1e-13, 0.2, 1.0}, {0.3, 0.2, 1.0}, {0.3, 0.2, 1.0}, {0.1, 0.6, 1.0}};
  ltcPolygonIntegral(ltc, tiny, &gradient);
  EXPECT_TRUE(gradient.allFinite());
  EXPECT_LT(gradientError(Matrix3d::Identity(), tiny, 1e-5), 1e-5);
  for (const double gap : {1e-3, 1e-6, 1e-9}) {
    const std::vector<Vector3d> flat{{-1.0, 0.0, gap}, {1.0, 0.0, gap}, {0.2, 1.0, 0.5}};
    ltcPolygonIntegral(ltc, flat, &gradient);
    EXPECT_TRUE(gradient.allFinite() && gradient.norm() < 10.0) << gap;
    // a step that is small against the distance of the edge from the origin
    EXPECT_LT(gradientError(Matrix3d::Identity(), flat, std::min(1e-5, 0.1 * gap)), gap < 1e-7 ? 1e-2 : 1e-3)
        << gap;
  }
  const std::vector<Vector3d> through{{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.2, 1.0, 0.5}};
  ltcPolygonIntegral(ltc, through, &gradient);
  EXPECT_TRUE(gradient.allFinite());
  ltcPolygonIntegral(ltc, std::vector<Vector3d>{{0, 0, 1}, {1, 0, 1}}, &gradient);
  EXPECT_EQ(gradient, Matrix3d::Zero());
  // scale and rotation about z change nothing
  const std::vector<Vector3d> light{{0.5, -0.4, 0.6}, {0.9, 0.3, -0.2}, {0.4, 0.5, 0.7}};
  ltcPolygonIntegral(ltc, light, &gradient);
  EXPECT_NEAR(gradient.trace(), 0.0, 1e-14);
  EXPECT_NEAR(gradient(0, 1) - gradient(1, 0), 0.0, 1e-14);
}

TEST(VectorFormFactor, ItsZIsTheIrradianceAboveTheHorizon) {
  Random random(3);
  for (int k = 0; k < 200; ++k) {
    PlanarPolygon polygon = randomPolygon(random);
    std::vector<Vector3d> v = polygon.vertices();
    double lowest = 0.0;
    for (const Vector3d& p : v) lowest = std::min(lowest, p.z());
    for (Vector3d& p : v) p.z() += 0.01 - lowest;
    EXPECT_NEAR(vectorFormFactor(v).z(), polygonIrradiance(v), 1e-13);
  }
}

TEST(VectorFormFactor, TurnsWithThePolygon) {
  const std::vector<Vector3d> v{{1, 0, 1}, {0, 1, 1}, {-1, -1, 1}};
  const Matrix3d r = Eigen::AngleAxisd(2.0, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Vector3d> turned;
  for (const Vector3d& p : v) turned.push_back(r * p);
  EXPECT_LT((vectorFormFactor(turned) - r * vectorFormFactor(v)).norm(), 1e-14);
}

TEST(ProxySphere, IsTheApproximationItIs) {
  EXPECT_EQ(proxySphereFormFactor({0, 0, -0.5}), 0.0);
  EXPECT_NEAR(proxySphereFormFactor({0, 0, 0.4}), 0.4, 1e-15);  // exact straight up
  EXPECT_NEAR(proxySphereFormFactor({0, 0, 1.0}), 1.0, 1e-15);
  // against the sphere that it stands for, of vector form factor F: exact above the horizon, up to 0.14 off
  // below
  double worst = 0.0;
  for (double length = 0.02; length <= 1.0; length += 0.02) {
    for (double cosine = -1.0; cosine <= 1.0; cosine += 0.02) {
      const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
      const double exact = sphereFormFactorClipped(cosine, std::sqrt(length));
      worst = std::max(worst, std::abs(proxySphereFormFactor({length * sine, 0.0, length * cosine}) - exact));
    }
  }
  EXPECT_LT(worst, 0.14);
  EXPECT_GT(worst, 0.10);
}

TEST(ProxySphere, OfAnLtcIsThatOfTheMovedPolygon) {
  Matrix3d m;
  m << 0.6, 0.1, 0.3, 0.0, 0.5, 0.2, -0.3, 0.1, 0.9;
  const std::vector<Vector3d> light{{0.5, -0.4, 0.6}, {0.9, 0.3, 0.4}, {0.4, 0.5, 0.7}};
  std::vector<Vector3d> moved;
  for (const Vector3d& v : light) moved.push_back(m.inverse() * v);
  EXPECT_NEAR(ltcPolygonIntegralByProxySphere(Ltc(m), light), proxySphereFormFactor(vectorFormFactor(moved)),
              1e-14);
  Matrix3d flipped = m;
  flipped.col(0) *= -1.0;
  EXPECT_NEAR(ltcPolygonIntegralByProxySphere(Ltc(flipped), light),
              ltcPolygonIntegralByProxySphere(Ltc(m), light), 1e-14);
}

TEST(ProxySphere, TheTableGivesThatSphereToo) {
  Matrix3d m;
  m << 0.6, 0.1, 0.3, 0.0, 0.5, 0.2, -0.3, 0.1, 0.9;
  const SphereTable table;
  const std::vector<Vector3d> above{{0.1, -0.2, 0.9}, {0.3, 0.1, 0.8}, {0.0, 0.2, 1.0}};
  // wholly above the horizon a sphere is F.z, as the polygon is; the table is bilinear
  EXPECT_NEAR(ltcPolygonIntegralBySphereTable(Ltc(m), above, table), ltcPolygonIntegral(Ltc(m), above), 1e-4);
  const std::vector<Vector3d> light{{0.9, -0.4, -0.1}, {0.9, 0.3, -0.2}, {0.7, 0.5, 0.7}};
  std::vector<Vector3d> moved;
  for (const Vector3d& v : light) moved.push_back(m.inverse() * v);
  const Vector3d f = vectorFormFactor(moved);
  EXPECT_NEAR(ltcPolygonIntegralBySphereTable(Ltc(m), light, table),
              sphereFormFactorClipped(f.z() / f.norm(), std::sqrt(f.norm())), 2e-3);
  Matrix3d flipped = m;
  flipped.col(0) *= -1.0;
  EXPECT_NEAR(ltcPolygonIntegralBySphereTable(Ltc(flipped), light, table),
              ltcPolygonIntegralBySphereTable(Ltc(m), light, table), 1e-14);
  EXPECT_EQ(ltcPolygonIntegralBySphereTable(Ltc(m), {}, table), 0.0);
}

}  // namespace
}  // namespace ltcfit
