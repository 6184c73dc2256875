// What keys and mouse do to a scene.
#include "render/viewer.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "ltc/polygon.h"

namespace ltcfit::test {
namespace {

Scene scene(const char* name) {
  Scene s;
  s.name = name;
  s.surfaces.resize(2);
  s.surfaces[0].material.alpha = Eigen::Vector2d(0.25, 0.25);
  s.surfaces[1].material.alpha = Eigen::Vector2d(0.1, 0.1);
  s.surfaces[1].material.alphaEnd = Eigen::Vector2d(0.5, 0.5);
  s.lights = {makeLight(LightShape::kQuad, Eigen::Vector3d(0, 1, 2), Eigen::Vector3d(0.1, 0.2, -1),
                        Eigen::Vector2d(1.0, 0.5))};
  s.lights[0].twoSided = true;
  s.lights[0].radiance = Eigen::Vector3d(1, 2, 3);
  return s;
}

Viewer twoScenes(bool isotropic = false) {
  return Viewer({scene("one"), scene("two")}, isotropic);
}

Eigen::Vector3d area(const PolygonLight& light) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < light.vertices.size(); ++i)
    sum += 0.5 * light.vertices[i].cross(light.vertices[(i + 1) % light.vertices.size()]);
  return sum;
}

TEST(Viewer, ShowsTheSceneAtTheSizeAsked) {
  const Scene s = twoScenes().scene(320, 200);
  EXPECT_EQ(s.name, "one");
  EXPECT_EQ(s.camera.width, 320u);
  EXPECT_EQ(s.camera.height, 200u);
  EXPECT_LT((s.camera.position - Camera().position).norm(), 1e-12);
  EXPECT_LT((s.lights[0].vertices[2] - scene("one").lights[0].vertices[2]).norm(), 1e-12);
}

TEST(Viewer, RoughnessChangesEveryMaterialWithinItsRange) {
  Viewer viewer = twoScenes();
  for (int i = 0; i < 4; ++i) viewer.apply(ViewerAction::kRougher);
  Scene s = viewer.scene(8, 8);
  EXPECT_NEAR(s.surfaces[0].material.alpha.x(), 0.5, 1e-12);
  EXPECT_NEAR(s.surfaces[0].material.alpha.y(), 0.5, 1e-12);
  EXPECT_FALSE(s.surfaces[0].material.isRamp());
  EXPECT_NEAR(s.surfaces[1].material.alpha.x(), 0.2, 1e-12);
  EXPECT_NEAR(s.surfaces[1].material.alphaEnd.x(), 1.0, 1e-12);
  for (int i = 0; i < 100; ++i) viewer.apply(ViewerAction::kRougher);
  EXPECT_EQ(viewer.scene(8, 8).surfaces[0].material.alpha.x(), 1.0);
  for (int i = 0; i < 300; ++i) viewer.apply(ViewerAction::kSmoother);
  EXPECT_EQ(viewer.scene(8, 8).surfaces[0].material.alpha.x(), 1e-4);
}

TEST(Viewer, AnisotropyIsForAnisotropicTables) {
  Viewer viewer = twoScenes();
  viewer.apply(ViewerAction::kMoreAnisotropic);
  viewer.apply(ViewerAction::kMoreAnisotropic);
  const Eigen::Vector2d alpha = viewer.scene(8, 8).surfaces[0].material.alpha;
  EXPECT_NEAR(alpha.x() / alpha.y(), 2.0, 1e-12);
  EXPECT_NEAR(alpha.x() * alpha.y(), 0.0625, 1e-12);
  for (int i = 0; i < 4; ++i) viewer.apply(ViewerAction::kLessAnisotropic);
  const Eigen::Vector2d across = viewer.scene(8, 8).surfaces[0].material.alpha;
  EXPECT_NEAR(across.y() / across.x(), 2.0, 1e-12);

  Viewer isotropic = twoScenes(true);
  isotropic.apply(ViewerAction::kMoreAnisotropic);
  EXPECT_TRUE(isotropic.scene(8, 8).isIsotropic());
}

TEST(Viewer, LightsKeepPlaceAreaAndSide) {
  Viewer viewer = twoScenes();
  const PolygonLight was = scene("one").lights[0];
  const std::vector<std::size_t> vertices{4, 10, 24, 4};
  for (std::size_t count : vertices) {
    viewer.apply(ViewerAction::kNextLight);
    const PolygonLight is = viewer.scene(8, 8).lights[0];
    EXPECT_EQ(is.vertices.size(), count);
    EXPECT_EQ(is.radiance, was.radiance);
    EXPECT_TRUE(is.twoSided);
    EXPECT_NEAR(area(is).normalized().dot(area(was).normalized()), 1.0, 1e-12);
    if (count == 4) {
      EXPECT_NEAR(area(is).norm(), area(was).norm(), 1e-12);
    }
  }
  for (int i = 0; i < 4; ++i) viewer.apply(ViewerAction::kLargerLights);
  EXPECT_NEAR(area(viewer.scene(8, 8).lights[0]).norm(), 4.0 * area(was).norm(), 1e-12);
  for (int i = 0; i < 8; ++i) viewer.apply(ViewerAction::kSmallerLights);
  EXPECT_NEAR(area(viewer.scene(8, 8).lights[0]).norm(), 0.25 * area(was).norm(), 1e-12);
}

TEST(Viewer, CameraOrbitsAndStopsAtThePoles) {
  Viewer viewer = twoScenes();
  const Camera was;
  viewer.orbit(0.5 * std::numbers::pi, 0.0);
  Camera is = viewer.scene(8, 8).camera;
  // from -y it goes to the right, to +x, at the same height
  EXPECT_LT((is.position - Eigen::Vector3d(5, 0, 2)).norm(), 1e-12);
  viewer.orbit(0.0, 0.2);
  is = viewer.scene(8, 8).camera;
  EXPECT_GT(is.position.z(), 2.0);
  EXPECT_NEAR(is.position.norm(), was.position.norm(), 1e-12);
  for (double up : {10.0, -20.0}) {
    viewer.orbit(0.0, up);
    is = viewer.scene(8, 8).camera;
    EXPECT_NEAR(std::abs(is.position.z()) / is.position.norm(), std::sin(89.0 * std::numbers::pi / 180.0),
                1e-9);
    EXPECT_GT(is.position.x(), 0.0);
  }
  viewer.zoom(1.0);
  EXPECT_NEAR(viewer.scene(8, 8).camera.position.norm(), 0.9 * was.position.norm(), 1e-12);
}

TEST(Viewer, ScenesGoAroundAndResetRestores) {
  Viewer viewer = twoScenes();
  viewer.apply(ViewerAction::kPreviousScene);
  EXPECT_EQ(viewer.scene(8, 8).name, "two");
  viewer.apply(ViewerAction::kNextScene);
  EXPECT_EQ(viewer.scene(8, 8).name, "one");
  const std::string title = viewer.title();
  EXPECT_EQ(title, "one: alpha 0.2500 x 0.2500, tangents 0 degrees, lights as in the scene x 1.00");
  for (ViewerAction action : {ViewerAction::kRougher, ViewerAction::kMoreAnisotropic, ViewerAction::kTurnLeft,
                              ViewerAction::kTurnLeft, ViewerAction::kTurnRight, ViewerAction::kLargerLights,
                              ViewerAction::kNextLight})
    viewer.apply(action);
  viewer.orbit(0.3, 0.3);
  EXPECT_EQ(viewer.title(), "one: alpha 0.3536 x 0.2500, tangents 5 degrees, lights quad x 1.19");
  viewer.apply(ViewerAction::kReset);
  EXPECT_EQ(viewer.title(), title);
  EXPECT_LT((viewer.scene(8, 8).camera.position - Camera().position).norm(), 1e-12);
}

}  // namespace
}  // namespace ltcfit::test
