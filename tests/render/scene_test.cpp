// Scenes, what their pixels see, and the twin that shades them.
#include "render/scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>

#include "export/read_table.h"
#include "ggx/random.h"
#include "ltc/polygon.h"
#include "render/lights.h"
#include "render/picture_error.h"
#include "render/scenes.h"
#include "render/twin.h"

namespace ltcfit {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Scene oneSphere() {
  Scene scene;
  Surface s;
  s.shape = SurfaceShape::kSphere;
  s.centre = Vector3d(0, 0, 1);
  s.radius = 1.0;
  scene.surfaces = {s};
  scene.camera.position = Vector3d(0, -5, 1);
  scene.camera.target = Vector3d(0, 0, 1);
  scene.camera.width = 31;
  scene.camera.height = 21;
  return scene;
}

TEST(ViewPixel, MiddleOfASphereIsSeenHeadOn) {
  const PixelView view = viewPixel(oneSphere(), 15, 10);
  ASSERT_EQ(view.kind, PixelKind::kSurface);
  EXPECT_LT((view.point.position - Vector3d(0, -1, 1)).norm(), 1e-12);
  EXPECT_LT((view.point.wo - Vector3d(0, 0, 1)).norm(), 1e-12);
  // around the z axis: at y = -1 that is +x
  EXPECT_LT((view.point.frame.row(0).transpose() - Vector3d(1, 0, 0)).norm(), 1e-12);
}

TEST(ViewPixel, RowsGoDownAndColumnsToTheRight) {
  Scene scene = oneSphere();
  EXPECT_GT(viewPixel(scene, 15, 8).point.position.z(), 1.0);
  EXPECT_GT(viewPixel(scene, 18, 10).point.position.x(), 0.0);
  EXPECT_EQ(viewPixel(scene, 0, 0).kind, PixelKind::kBackground);
}

TEST(ViewPixel, FramesAreRightHandedAndTurned) {
  Scene scene = oneSphere();
  scene.surfaces[0].material.rotation = 0.7;
  const PixelView view = viewPixel(scene, 13, 7);
  const Eigen::Matrix3d& f = view.point.frame;
  EXPECT_LT((f * f.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_NEAR(f.determinant(), 1.0, 1e-12);
  scene.surfaces[0].material.rotation = 0.0;
  const Eigen::Matrix3d& plain = viewPixel(scene, 13, 7).point.frame;
  EXPECT_NEAR(std::atan2(f.row(0).dot(plain.row(1)), f.row(0).dot(plain.row(0))), 0.7, 1e-12);
}

TEST(ViewPixel, RectanglesAreSeenFromTheirFrontOnly) {
  Scene scene = oneSphere();
  Surface ground;
  scene.surfaces = {ground};
  scene.camera.position = Vector3d(0, -5, 2);
  scene.camera.target = Vector3d::Zero();
  EXPECT_EQ(viewPixel(scene, 15, 10).kind, PixelKind::kSurface);
  scene.camera.position.z() = -2;
  EXPECT_EQ(viewPixel(scene, 15, 10).kind, PixelKind::kBackground);
}

TEST(ViewPixel, ALightHidesWhatIsBehindAndNotWhatIsBefore) {
  Scene scene = oneSphere();
  scene.lights = {makeLight(LightShape::kStar, Vector3d(0, -2, 1), Vector3d(0, 1, 0), Vector2d(0.5, 0.5))};
  EXPECT_EQ(viewPixel(scene, 15, 10).kind, PixelKind::kLight);
  scene.lights[0] = makeLight(LightShape::kStar, Vector3d(0, 2, 1), Vector3d(0, -1, 0), Vector2d(0.5, 0.5));
  EXPECT_EQ(viewPixel(scene, 15, 10).kind, PixelKind::kSurface);
}

TEST(ViewPixel, NotchesOfAStarAreOpen) {
  Scene scene = oneSphere();
  scene.surfaces.clear();
  scene.lights = {makeLight(LightShape::kStar, Vector3d(0, 0, 1), Vector3d(0, -1, 0), Vector2d(1, 1))};
  scene.camera.width = 101;
  scene.camera.height = 101;
  std::size_t seen = 0;
  for (std::size_t row = 0; row < 101; ++row)
    for (std::size_t column = 0; column < 101; ++column)
      if (viewPixel(scene, column, row).kind == PixelKind::kLight) ++seen;
  // area of the star, 10 triangles of sides 1 and 0.4, in units of the picture's at distance 5
  const double area = 10 * 0.5 * 0.4 * std::sin(std::numbers::pi / 5);
  const double side = 2.0 * 5.0 * std::tan(0.35);
  EXPECT_NEAR(static_cast<double>(seen) / (101.0 * 101.0), area / (side * side), 0.002);
}

TEST(ViewPixel, RampsAreEvenInTheRootOfAlpha) {
  Scene scene = oneSphere();
  Surface ground;
  ground.material.alpha.setConstant(0.01);
  ground.material.alphaEnd = Vector2d(1.0, 0.25);
  scene.surfaces = {ground};
  scene.camera.position = Vector3d(0, -0.01, 8);
  scene.camera.target = Vector3d::Zero();
  const PixelView view = viewPixel(scene, 22, 10);
  ASSERT_EQ(view.kind, PixelKind::kSurface);
  const double along = 0.5 + view.point.position.x() / 8.0;
  EXPECT_NEAR(std::sqrt(view.point.alpha.x()), 0.1 + 0.9 * along, 1e-12);
  EXPECT_NEAR(std::sqrt(view.point.alpha.y()), 0.1 + 0.4 * along, 1e-12);
}

TEST(MakeLight, ShinesForwardsOnly) {
  for (const char* const name : {"quad", "star", "disk-as-polygon"}) {
    PolygonLight light = makeLight(lightShapeFromName(name), Vector3d(0.1, 0.2, 2), Vector3d(0.2, 0.1, -1),
                                   Vector2d(0.8, 0.5), 0.4);
    EXPECT_GT(polygonIrradiance(light.vertices), 0.01) << name;
    light = makeLight(lightShapeFromName(name), Vector3d(0.1, 0.2, 2), Vector3d(-0.2, -0.1, 1),
                      Vector2d(0.8, 0.5), 0.4);
    EXPECT_LT(polygonIrradiance(light.vertices), -0.01) << name;
  }
  EXPECT_THROW(lightShapeFromName("tube"), std::invalid_argument);
}

TEST(MakeLight, TheDiskHasTheDisksArea) {
  const PolygonLight light =
      makeLight(LightShape::kDisk, Vector3d(0, 0, 2), Vector3d(0, 0, -1), Vector2d(0.8, 0.5));
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < light.vertices.size(); ++i)
    sum += light.vertices[i].cross(light.vertices[(i + 1) % light.vertices.size()]);
  EXPECT_NEAR(0.5 * sum.norm(), std::numbers::pi * 0.8 * 0.5, 1e-9);
}

TEST(Scenes, FitIntoTheShader) {
  std::set<std::string> names;
  for (const bool anisotropic : {false, true}) {
    for (const CheckScene& check : namedScenes(anisotropic)) {
      EXPECT_LE(check.scene.surfaces.size(), kMaxSurfaces) << check.scene.name;
      EXPECT_LE(check.scene.lights.size(), kMaxLights) << check.scene.name;
      for (const PolygonLight& light : check.scene.lights)
        EXPECT_LE(light.vertices.size(), kMaxLightVertices) << check.scene.name;
      EXPECT_TRUE(anisotropic || check.scene.isIsotropic()) << check.scene.name;
      EXPECT_GE(check.psnrFloor, 40.0) << check.scene.name;
      if (anisotropic) {
        EXPECT_TRUE(names.insert(check.scene.name).second) << check.scene.name << " twice";
      }
    }
  }
}

TEST(RandomScenes, AreTheSameForASeedAndShowSurfaces) {
  const Scene a = randomScene(3, 17, true, 16);
  const Scene b = randomScene(3, 17, true, 16);
  EXPECT_EQ(a.lights[0].vertices, b.lights[0].vertices);
  EXPECT_EQ(a.camera.position, b.camera.position);
  EXPECT_NE(randomScene(4, 17, true, 16).camera.position, a.camera.position);
  EXPECT_NE(randomScene(3, 18, true, 16).camera.position, a.camera.position);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Scene scene = randomScene(1, i, false, 16);
    EXPECT_TRUE(scene.isIsotropic());
    std::size_t seen = 0;
    for (std::size_t k = 0; k < 256; ++k)
      if (viewPixel(scene, k % 16, k / 16).kind == PixelKind::kSurface) ++seen;
    EXPECT_GE(seen, 30u) << i;
  }
}

TEST(RandomScenes, CoverTheOffGridDistribution) {
  double rootSum = 0.0;
  int rougherAcross = 0;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const double root = std::sqrt(randomScene(1, i, false, 8).surfaces[0].material.alpha.x());
    EXPECT_GE(root, 0.05);
    EXPECT_LE(root, 1.0);
    rootSum += root;
    const Vector2d alpha = randomScene(1, i, true, 8).surfaces[0].material.alpha;
    EXPECT_GE(alpha.maxCoeff(), 0.03);
    EXPECT_GE(alpha.minCoeff(), 0.05 * alpha.maxCoeff());
    if (alpha.y() > alpha.x()) ++rougherAcross;
  }
  EXPECT_NEAR(rootSum / 400, 0.525, 0.05);  // 3.5 standard errors of the mean
  EXPECT_NEAR(rougherAcross, 200, 35);      // 3.5 standard deviations
}

// The integral of the table's lobe over a light by counting its samples: shares nothing with the closed form.
TEST(Twin, IsTheShareOfTheLobesSamplesThatMeetTheLight) {
  for (const bool anisotropic : {false, true}) {
    const Table stored =
        readTable(std::string(LTCFIT_DATA_DIR) + (anisotropic ? "/ltc_aniso.json" : "/ltc_iso.json"));
    Scene scene = makeScene({LightShape::kQuad, anisotropic ? Vector2d(0.1, 0.5) : Vector2d(0.3, 0.3), 0.8});
    scene.camera.width = 16;
    scene.camera.height = 12;
    scene.surfaces[0].material.f0 = 0.3;
    const Film film = renderTwin(scene, stored);
    Random random(5);
    int tried = 0;
    for (std::size_t pixel = 0; pixel < film.radiance.size(); pixel += 5) {
      if (film.kinds[pixel] != PixelKind::kSurface || film.radiance[pixel].x() < 0.02) continue;
      ++tried;
      const PixelView view = viewPixel(scene, pixel % 16, pixel / 16);
      ASSERT_EQ(view.kind, PixelKind::kSurface);
      const SurfacePoint& p = view.point;
      const Vector3d wo = p.wo;
      const TableEntry entry = stored.fetch(
          {p.alpha.x(), p.alpha.y(), std::acos(wo.z()), anisotropic ? std::atan2(wo.y(), wo.x()) : 0.0});
      // world directions of the lobe; an isotropic table's frame has the view in its x-z plane
      Eigen::Matrix3d toWorld = p.frame.transpose();
      if (!anisotropic) {
        const Vector3d n = p.frame.row(2);
        const Vector3d v = p.frame.transpose() * wo;
        toWorld.col(0) = (v - n * n.dot(v)).normalized();
        toWorld.col(1) = n.cross(toWorld.col(0));
      }
      const PolygonLight& light = scene.lights[0];
      const Vector3d normal =
          (light.vertices[1] - light.vertices[0]).cross(light.vertices[3] - light.vertices[0]);
      const Vector3d e1 = light.vertices[1] - light.vertices[0];
      const Vector3d e2 = light.vertices[3] - light.vertices[0];
      const int n = 50000;
      int hits = 0;
      const Ltc lobe(entry.m);
      for (int i = 0; i < n; ++i) {
        const Vector2d u(random.uniform(), random.uniform());
        const Vector3d d = toWorld * lobe.sample(u);
        const double t = (light.vertices[0] - p.position).dot(normal) / d.dot(normal);
        const Vector3d q = p.position + t * d - light.vertices[0];
        const double a = q.dot(e1) / e1.squaredNorm();
        const double b = q.dot(e2) / e2.squaredNorm();
        // from the front: against its normal turned away
        if (t > 0 && d.dot(normal) > 0 && a > 0 && a < 1 && b > 0 && b < 1) ++hits;
      }
      const double f0 = p.surface->material.f0;
      const double expected = (f0 * *entry.norm + (1 - f0) * *entry.fresnel) * static_cast<double>(hits) / n;
      // 4 standard errors of the count
      EXPECT_NEAR(film.radiance[pixel].x(), expected, 4.0 * 0.5 / std::sqrt(n) + 1e-6)
          << anisotropic << pixel;
    }
    EXPECT_GE(tried, 5);
  }
}

TEST(Twin, AsksForNormAndFresnel) {
  const Table table = readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_iso.json");
  TableInfo info = table.info();
  std::vector<float> data;
  const std::size_t channels = table.channelCount();
  for (std::size_t i = 0; i < table.nodeCount(); ++i)
    for (std::size_t c = 0; c < channels; ++c)
      if (info.channels[c] != "norm") data.push_back(table.data()[i * channels + c]);
  std::erase(info.channels, "norm");
  EXPECT_THROW(renderTwin(makeScene({}), Table(info, data)), std::invalid_argument);
}

TEST(PictureError, KnownDifferences) {
  Film a(4, 2);
  Film b(4, 2);
  a.kinds.assign(8, PixelKind::kSurface);
  b.kinds = a.kinds;
  for (Vector3d& v : a.radiance) v = Vector3d::Constant(0.6);
  for (Vector3d& v : b.radiance) v = Vector3d::Constant(0.5);
  PictureError e = pictureError(a, b);
  EXPECT_EQ(e.pixels, 8u);
  EXPECT_NEAR(e.rmse, 0.1, 1e-12);
  EXPECT_NEAR(e.psnr, 20.0, 1e-9);
  EXPECT_NEAR(e.relativeMse, 0.01 / 0.26, 1e-12);
  EXPECT_NEAR(e.largest, 0.1, 1e-12);
  // one channel of one pixel
  a = b;
  a.radiance[3].y() += 0.6;
  e = pictureError(a, b);
  EXPECT_NEAR(e.rmse, std::sqrt(0.36 / 24), 1e-12);
  // of a darker peak
  EXPECT_NEAR(pictureError(a, b, 0.1).psnr, pictureError(a, b).psnr - 20.0, 1e-9);
  EXPECT_NEAR(brightest(a), 1.1, 1e-12);
  EXPECT_EQ(pictureError(a, a).psnr, 150.0);
  EXPECT_EQ(pictureError(a, a).rmse, 0.0);
}

TEST(PictureError, CountsWhatItLeavesOut) {
  Film a(3, 1);
  a.kinds.assign(3, PixelKind::kSurface);
  Film b = a;
  a.radiance[0].x() = std::nan("");
  b.kinds[1] = PixelKind::kLight;
  b.radiance[1].setConstant(7.0);
  const PictureError e = pictureError(a, b);
  EXPECT_EQ(e.nonFinite, 1u);
  EXPECT_EQ(e.kindsDiffer, 1u);
  EXPECT_EQ(e.pixels, 1u);
  EXPECT_EQ(e.rmse, 0.0);
}

}  // namespace
}  // namespace ltcfit
