#include "render/solid_angle_sampler.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

#include "ggx/random.h"
#include "render/light_plane.h"
#include "tests/support/chi_square.h"

namespace ltcfit {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr int kCells = 16;
constexpr int kFine = 24;
constexpr int kSamples = 60000;

PolygonLight quad(const Vector3d& centre, const Vector3d& x, const Vector3d& y) {
  PolygonLight light;
  light.vertices = {centre - x - y, centre + x - y, centre + x + y, centre - x + y};
  return light;
}

PolygonLight star(const Vector3d& centre, const Vector3d& x, const Vector3d& y) {
  PolygonLight light;
  for (int k = 0; k < 10; ++k) {
    const double r = k % 2 == 0 ? 1.0 : 0.35;
    light.vertices.push_back(centre + r * std::cos(0.2 * kPi * k) * x + r * std::sin(0.2 * kPi * k) * y);
  }
  return light;
}

struct Bins {
  LightPlane plane;
  Vector2d low, size;

  explicit Bins(const PolygonLight& light) : plane(light), low(plane.outline[0]), size(plane.outline[0]) {
    for (const Vector2d& p : plane.outline) {
      low = low.cwiseMin(p);
      size = size.cwiseMax(p);
    }
    size -= low;
  }
  // Cells of the bounding box in the light's plane; one more for all that misses it.
  std::size_t of(const Vector3d& wi) const {
    const Vector3d hit = wi * (plane.origin.dot(plane.normal) / wi.dot(plane.normal)) - plane.origin;
    const Vector2d place = (Vector2d(hit.dot(plane.x), hit.dot(plane.y)) - low).cwiseQuotient(size) * kCells;
    const bool in = place.minCoeff() > -1e-6 && place.maxCoeff() < kCells + 1e-6 && wi.z() > -1e-12;
    if (!in) return kCells * kCells;
    const auto cell = [](double x) { return static_cast<std::size_t>(std::clamp(x, 0.0, kCells - 1.0)); };
    return cell(place.y()) * kCells + cell(place.x());
  }
  // Solid angles of the cells' parts in the light above the horizon, by the midpoint rule.
  std::vector<double> solidAngles() const {
    std::vector<double> out(kCells * kCells + 1, 0.0);
    const int n = kCells * kFine;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const Vector2d p = low + size.cwiseProduct(Vector2d(j + 0.5, i + 0.5) / n);
        const Vector3d v = plane.origin + p.x() * plane.x + p.y() * plane.y;
        if (!plane.contains(p) || v.z() <= 0.0) continue;
        out[static_cast<std::size_t>((i / kFine) * kCells + j / kFine)] +=
            std::abs(v.dot(plane.normal)) / std::pow(v.norm(), 3.0) * size.prod() / (n * n);
      }
    }
    return out;
  }
};

using Sampler = std::function<Vector3d(const Vector2d&)>;

double deviations(const Bins& bins, const Sampler& sampler) {
  Random random(11);
  std::vector<double> observed(kCells * kCells + 1, 0.0);
  for (int i = 0; i < kSamples; ++i) observed[bins.of(sampler({random.uniform(), random.uniform()}))] += 1.0;
  std::vector<double> expected = bins.solidAngles();
  double total = 0.0;
  for (const double e : expected) total += e;
  for (double& e : expected) e *= kSamples / total;
  return test::chiSquareDeviations(observed, expected);
}

SolidAngleSampler samplerOf(const LightPlane& plane, const PolygonLight& light) {
  SolidAngleSampler sampler;
  sampler.set(light.vertices, plane.triangles);
  return sampler;
}

std::vector<PolygonLight> lights() {
  return {quad({0, 0, 1}, {0.5, 0, 0}, {0, 0.5, 0}),
          quad({0.3, 0.2, 0.2}, {3, 0, 0}, {0, 2, 0}),           // close and wide
          quad({1, 0, 0.4}, {0, 1, 0}, {0.2, 0, 1}),             // through the horizon
          quad({300, 100, 200}, {0.1, 0, 0.01}, {0, 0.2, 0.1}),  // far and small
          star({0.5, 0.3, 1}, {1, 0.2, 0}, {0, 1, 0.3}),
          star({1, 0.3, 0.2}, {0.1, 1, 0}, {0.2, 0, 1})};  // not convex through the horizon
}

TEST(SolidAngleSampler, DirectionsAreEven) {
  const double threshold = test::sidakThreshold(static_cast<int>(lights().size()));
  for (const PolygonLight& light : lights()) {
    const Bins bins(light);
    const SolidAngleSampler sampler = samplerOf(bins.plane, light);
    double total = 0.0;
    for (const double s : bins.solidAngles()) total += s;
    EXPECT_NEAR(sampler.solidAngle(), total, 4e-3 * total);  // the grid's error at slanted edges
    EXPECT_LT(deviations(bins, [&](const Vector2d& u) { return sampler.sample(u); }), threshold)
        << light.vertices[0].transpose();
  }
}

TEST(SolidAngleSampler, EvenOverTheAreaIsNotEvenOverDirections) {
  const PolygonLight light = quad({0.3, 0.2, 0.5}, {1, 0, 0}, {0, 1, 0});
  const Bins bins(light);
  const auto even = [&](const Vector2d& u) {
    return Vector3d(0.3 + 2.0 * u.x() - 1.0, 0.2 + 2.0 * u.y() - 1.0, 0.5).normalized();
  };
  EXPECT_GT(deviations(bins, even), 20.0);
  // nor is the sphere's triangle by its flat one's map, as if it were small
  const SolidAngleSampler sampler = samplerOf(bins.plane, light);
  const auto rootless = [&](const Vector2d& u) { return sampler.sample({u.x(), u.y() * u.y()}); };
  EXPECT_GT(deviations(bins, rootless), 20.0);
}

TEST(SphericalTriangle, KnownSolidAngles) {
  EXPECT_NEAR(SphericalTriangle(Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()).solidAngle(),
              0.5 * kPi, 1e-15);
  EXPECT_NEAR(SphericalTriangle({3, 0, 0}, {0, 0, 0.1}, {0, 7, 0}).solidAngle(), 0.5 * kPi, 1e-15);
  // a face of a cube is seen from its middle under 4 pi / 6, half of it is the triangle
  EXPECT_NEAR(SphericalTriangle({-1, -1, 1}, {1, -1, 1}, {1, 1, 1}).solidAngle(), kPi / 3.0, 1e-15);
  // just above its plane, inside: half of the sphere
  EXPECT_NEAR(SphericalTriangle({-1, -1, 1e-12}, {2, -1, 1e-12}, {-1, 2, 1e-12}).solidAngle(), 2.0 * kPi,
              1e-10);
}

TEST(SphericalTriangle, TinyOnesKeepTheirAccuracyAndTheirSamples) {
  const Vector3d centre = Vector3d(0.3, -0.5, 0.7).normalized();
  const Vector3d x = centre.unitOrthogonal();
  const Vector3d y = centre.cross(x);
  for (const double size : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const Vector3d a = centre - size * x;
    const Vector3d b = centre + size * x;
    const Vector3d c = centre + 2.0 * size * y;
    const SphericalTriangle triangle(a, b, c);
    // area / distance^2; vertices are rounded to 1e-16, and it is flat to size^2
    EXPECT_NEAR(triangle.solidAngle() / (2.0 * size * size), 1.0, 1e-15 / size + 3.0 * size * size) << size;
    Random random(7);
    Vector3d mean = Vector3d::Zero();
    for (int i = 0; i < 4000; ++i) {
      const Vector3d w = triangle.sample({random.uniform(), random.uniform()});
      EXPECT_NEAR(w.norm(), 1.0, 1e-14);
      mean += (w - centre) / (4000.0 * size);
    }
    // the centroid, to 5 standard errors of 4000 samples
    EXPECT_NEAR(mean.dot(x), 0.0, 0.035 + 1e-15 / size) << size;
    EXPECT_NEAR(mean.dot(y), 2.0 / 3.0, 0.04 + 1e-15 / size) << size;
  }
}

TEST(SphericalTriangle, EdgesOfHalfACircleKeepUnitSamples) {
  // an edge that passes the point closely is seen under nearly pi
  for (const double gap : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const SphericalTriangle triangle({-1, 0.1, 1}, {-1, gap, 0}, {1, gap, 0});
    Random random(5);
    for (int i = 0; i < 1000; ++i) {
      const Vector3d w = triangle.sample({i % 4 == 0 ? 1.0 : random.uniform(), random.uniform()});
      // rounding over the sine of the arc from b
      EXPECT_NEAR(w.norm(), 1.0, 1e-15 / gap) << gap;
    }
  }
}

TEST(SphericalTriangle, CornersOfTheSquareStayInIt) {
  Random random(9);
  for (int i = 0; i < 3000; ++i) {
    std::array<Vector3d, 3> v;
    for (Vector3d& p : v) p = Vector3d(random.normal(), random.normal(), random.normal());
    if (i % 3 == 0) v[2] = v[0] + 1e-7 * v[1];   // slivers
    if (i % 7 == 0) v[1] = -v[0] + 1e-9 * v[2];  // nearly through the origin
    const SphericalTriangle triangle(v[0], v[1], v[2]);
    const double side = v[0].dot(v[1].cross(v[2]));
    for (const double s : {0.0, 1e-10, 0.5, 1.0 - 1e-10, 1.0}) {
      for (const double t : {0.0, 1e-10, 0.5, 1.0 - 1e-10, 1.0}) {
        const Vector3d w = triangle.sample({s, t});
        ASSERT_TRUE(w.allFinite()) << i;
        if (i % 3 == 0 || i % 7 == 0) continue;  // their planes are not known well enough
        for (std::size_t k = 0; k < 3; ++k) {
          const Vector3d normal = v[k].cross(v[(k + 1) % 3]).normalized();
          EXPECT_GT(w.dot(normal) * (side > 0.0 ? 1.0 : -1.0), -1e-9) << i << " " << s << " " << t;
        }
      }
    }
  }
}

TEST(SolidAngleSampler, NothingIsSeenOfDegenerateAndHiddenLights) {
  SolidAngleSampler sampler;
  const std::vector<std::array<std::size_t, 3>> one{{0, 1, 2}};
  const auto angle = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    sampler.set(std::vector<Vector3d>{a, b, c}, one);
    return sampler.solidAngle();
  };
  EXPECT_GT(angle({1, 0, 1}, {0, 1, 1}, {0, 0, 1}), 0.1);
  EXPECT_EQ(angle({1, 0, -1}, {0, 1, -1}, {0, 0, -1}), 0.0);  // below
  EXPECT_EQ(angle({1, 0, 0}, {0, 1, 0}, {-1, -1, 0}), 0.0);   // in the horizon
  EXPECT_EQ(angle({1, 1, 1}, {1, 1, 1}, {1, 1, 1}), 0.0);     // a point
  EXPECT_EQ(angle({1, 0, 1}, {2, 0, 2}, {3, 0, 3}), 0.0);     // a line through the origin
  EXPECT_EQ(angle({0, 0, 0}, {0, 1, 1}, {1, 0, 1}), 0.0);     // a vertex at the point
  EXPECT_EQ(angle({-1, 0, 1}, {1, 0, -1}, {0, 0, 5}), 0.0);   // edge on
}

}  // namespace
}  // namespace ltcfit
