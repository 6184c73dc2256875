#include "render/light_plane.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ggx/random.h"

namespace ltcfit {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Outline = std::vector<Vector2d>;

double signedArea(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return 0.5 * ((b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()));
}

double signedArea(const Outline& outline) {
  double sum = 0.0;
  for (std::size_t i = 2; i < outline.size(); ++i) sum += signedArea(outline[0], outline[i - 1], outline[i]);
  return sum;
}

Outline star(int points, double inner) {
  Outline out;
  for (int k = 0; k < 2 * points; ++k) {
    const double angle = std::numbers::pi * k / points;
    out.push_back((k % 2 == 0 ? 1.0 : inner) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return out;
}

// All triangles wound as the outline is, of its area together, and random points in as many of them as they
// are in the outline.
void expectTiles(const Outline& outline) {
  const std::vector<std::array<std::size_t, 3>> triangles = triangulate(outline);
  const double area = signedArea(outline);
  double sum = 0.0;
  for (const auto& t : triangles) {
    const double one = signedArea(outline[t[0]], outline[t[1]], outline[t[2]]);
    EXPECT_GT(one * area, 0.0);
    sum += one;
  }
  EXPECT_NEAR(sum, area, 1e-12);
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vector2d p(2.4 * random.uniform() - 1.2, 2.4 * random.uniform() - 1.2);
    bool inside = false;
    for (std::size_t k = 0; k < outline.size(); ++k)
      inside ^= crossesEdge(outline[k], outline[(k + 1) % outline.size()], p);
    int covered = 0;
    for (const auto& t : triangles) {
      bool in = false;
      for (std::size_t k = 0; k < 3; ++k) in ^= crossesEdge(outline[t[k]], outline[t[(k + 1) % 3]], p);
      covered += in;
    }
    EXPECT_EQ(covered, inside ? 1 : 0) << p.transpose();
  }
}

TEST(Triangulate, TilesConvexAndOtherOutlinesOfEitherWinding) {
  const Outline square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const Outline comb{{-1, -1}, {1, -1},   {1, 1},       {0.6, 1},     {0.6, -0.5}, {0.2, -0.5},
                     {0.2, 1}, {-0.2, 1}, {-0.2, -0.5}, {-0.6, -0.5}, {-0.6, 1},   {-1, 1}};
  const Outline arrow{{-1, -1}, {0, -0.9}, {1, -1}, {0, 1}};
  for (Outline outline : {square, comb, arrow, star(5, 0.4), star(12, 0.1), star(3, 0.02)}) {
    expectTiles(outline);
    EXPECT_LE(triangulate(outline).size(), outline.size() - 2);
    std::reverse(outline.begin(), outline.end());
    expectTiles(outline);
  }
}

TEST(Triangulate, VerticesOnALineAndDoubleOnesAreDropped) {
  const Outline outline{{-1, -1}, {0, -1}, {1, -1}, {1, 0.3}, {1, 1}, {1, 1}, {-1, 1}, {-1, 0}};
  expectTiles(outline);
  EXPECT_EQ(triangulate(outline).size(), 2u);
}

TEST(Triangulate, WithoutAreaThereAreNone) {
  EXPECT_TRUE(triangulate(Outline{}).empty());
  EXPECT_TRUE(triangulate(Outline{{0, 0}, {0, 0}, {0, 0}}).empty());
  EXPECT_TRUE(triangulate(Outline{{0, 0}, {1, 1}, {2, 2}}).empty());
  EXPECT_TRUE(triangulate(Outline{{0, 0}, {1, std::nan("")}, {2, 2}}).empty());
}

TEST(Triangulate, AnOutlineThatCrossesItselfEnds) {
  const Outline bow{{-1, -1}, {1, 1}, {1, -1}, {-1, 1.5}};
  EXPECT_LE(triangulate(bow).size(), 2u);
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    Outline outline;
    for (int k = 0; k < 3 + i % 22; ++k) outline.emplace_back(random.normal(), random.normal());
    EXPECT_LE(triangulate(outline).size(), outline.size() - 2);
  }
}

TEST(LightPlane, ItsFrameIsTheLights) {
  PolygonLight light;
  light.vertices = {{1, 2, 3}, {1, 4, 3}, {1, 4, 6}, {1, 2, 6}};
  const LightPlane plane(light);
  EXPECT_LT((plane.normal - Vector3d::UnitX()).norm(), 1e-15);
  EXPECT_LT((plane.x.cross(plane.y) - plane.normal).norm(), 1e-15);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d back = plane.origin + plane.outline[i].x() * plane.x + plane.outline[i].y() * plane.y;
    EXPECT_LT((back - light.vertices[i]).norm(), 1e-14);
  }
  EXPECT_TRUE(plane.contains({1.9, 2.9}));
  EXPECT_FALSE(plane.contains({2.1, 2.9}));
  EXPECT_FALSE(plane.contains({1.0, -0.1}));
}

TEST(LightPlane, AgreesWithWhatTheCameraSees) {
  // the same star hit by a camera's rays, by scene.cpp
  Scene scene;
  scene.camera.position = {0.3, -4.0, 1.0};
  scene.camera.target = {0.0, 0.0, 1.0};
  PolygonLight light;
  for (const Vector2d& p : star(5, 0.35)) light.vertices.emplace_back(p.x(), 0.2 * p.x(), 1.0 + p.y());
  scene.lights.push_back(light);
  const LightPlane plane(light);
  int seen = 0;
  for (std::size_t row = 0; row < scene.camera.height; ++row) {
    for (std::size_t column = 0; column < scene.camera.width; ++column) {
      const Vector3d forward = (scene.camera.target - scene.camera.position).normalized();
      const Vector3d right = forward.cross(scene.camera.up).normalized();
      const double half = std::tan(0.5 * scene.camera.verticalFov);
      const double x = (2.0 * (static_cast<double>(column) + 0.5) / 160.0 - 1.0) * half * 160.0 / 120.0;
      const double y = (1.0 - 2.0 * (static_cast<double>(row) + 0.5) / 120.0) * half;
      const Vector3d ray = forward + x * right + y * right.cross(forward);
      const double t = (plane.origin - scene.camera.position).dot(plane.normal) / ray.dot(plane.normal);
      const Vector3d hit = scene.camera.position + t * ray - plane.origin;
      const bool inside = plane.contains({hit.dot(plane.x), hit.dot(plane.y)});
      EXPECT_EQ(inside, viewPixel(scene, column, row).kind == PixelKind::kLight) << column << " " << row;
      seen += inside;
    }
  }
  EXPECT_GT(seen, 1000);
}

}  // namespace
}  // namespace ltcfit
