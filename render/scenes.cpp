#include "render/scenes.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

namespace ltcfit {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kQuarterTurn = 0.5 * std::numbers::pi;

Material glossy(double alpha) {
  Material m;
  m.alpha.setConstant(alpha);
  return m;
}

Material brushed(double alphaX, double alphaY, double rotation = 0.0) {
  Material m;
  m.alpha = Vector2d(alphaX, alphaY);
  m.rotation = rotation;
  return m;
}

Surface ground(const Material& material, double halfSize = 4.0) {
  Surface s;
  s.halfSize.setConstant(halfSize);
  s.material = material;
  return s;
}

Surface sphere(const Vector3d& centre, double radius, const Material& material) {
  Surface s;
  s.shape = SurfaceShape::kSphere;
  s.centre = centre;
  s.radius = radius;
  s.material = material;
  return s;
}

Scene groundAndSphere(const Material& material) {
  Scene scene;
  scene.camera.position = Vector3d(0.6, -5.0, 2.2);
  scene.camera.target = Vector3d(0, 0.3, 0.6);
  scene.surfaces = {ground(material), sphere(Vector3d(-0.9, 0.2, 0.7), 0.7, material)};
  return scene;
}

// Behind the sphere, facing the camera's side and slightly down.
PolygonLight backLight(LightShape shape) {
  return makeLight(shape, Vector3d(0.8, 2.0, 1.3), Vector3d(-0.1, -1.0, -0.25), Vector2d(1.0, 0.7), 0.2);
}

// A plane of one ramp of roughness, and a light behind it as wide as it.
Scene rampUnderAWideLight(const Material& ramp) {
  Scene s;
  s.camera.position = Vector3d(0, -6.0, 2.4);
  s.camera.target = Vector3d(0, 0.4, 0.3);
  s.surfaces = {ground(ramp, 3.0)};
  s.lights = {makeLight(LightShape::kQuad, Vector3d(0, 2.6, 1.1), Vector3d(0, -1, -0.1), Vector2d(2.6, 0.8))};
  return s;
}

CheckScene named(Scene scene, const char* name, const char* title, double floor, const char* loss) {
  scene.name = name;
  scene.title = title;
  return {std::move(scene), floor, loss};
}

const char* const kRounding = "float32 look-up, inverse and edge sums, some 1e-6 each";
// Emulated for the anisotropic table: 45 dB where weights have 8 bits; 97 dB with float32 weights.
const char* const kMirror =
    "the outline of a mirror's reflection moves with every bit, above all where texture units filter with 8 "
    "bits";
const char* const kSharp =
    "a sharp lobe moves by the rounding of its inverse, so that outlines of the reflection shift";

std::vector<CheckScene> isotropicScenes() {
  std::vector<CheckScene> out;
  {
    Scene s = groundAndSphere(glossy(0.25));
    s.lights = {backLight(LightShape::kQuad)};
    out.push_back(
        named(s, "rectangle", "a plane and a sphere under a rectangular light, alpha 0.25", 50, kRounding));
  }
  {
    Material m = glossy(0.16);
    m.f0 = 0.04;
    m.diffuse = 0.6;
    Scene s = groundAndSphere(m);
    s.lights = {backLight(LightShape::kQuad)};
    out.push_back(
        named(s, "plastic", "diffuse and Fresnel: f0 0.04 over an albedo of 0.6, alpha 0.16", 50, kRounding));
  }
  {
    Scene s = groundAndSphere(glossy(0.09));
    s.lights = {makeLight(LightShape::kStar, Vector3d(0.7, 1.8, 1.4), Vector3d(-0.1, -1.0, -0.2),
                          Vector2d(1.2, 1.2), 0.3)};
    out.push_back(named(s, "star", "a star-shaped light, which is not convex, alpha 0.09", 50, kRounding));
  }
  {
    Scene s = groundAndSphere(glossy(0.2));
    s.lights = {makeLight(LightShape::kDisk, Vector3d(0.9, 1.6, 1.2), Vector3d(-0.2, -1.0, -0.2),
                          Vector2d(0.9, 0.9))};
    out.push_back(named(s, "disk", "a disk as a polygon of 24 vertices, alpha 0.2", 50, kRounding));
  }
  {
    Scene s = groundAndSphere(glossy(0.3));
    s.lights = {
        makeLight(LightShape::kQuad, Vector3d(0.4, 1.6, 0.0), Vector3d(0, -1, 0.1), Vector2d(1.6, 0.9), 0.5)};
    out.push_back(named(s, "horizon",
                        "a light through the ground: half of it is below the horizon, alpha 0.3", 50,
                        kRounding));
  }
  {
    Scene s = groundAndSphere(glossy(0.12));
    s.lights = {
        makeLight(LightShape::kQuad, Vector3d(1.2, 1.4, 0.8), Vector3d(-0.3, -1, 0), Vector2d(0.7, 0.8)),
        makeLight(LightShape::kQuad, Vector3d(-2.2, 1.0, 0.5), Vector3d(1, -0.4, 0), Vector2d(0.8, 0.5))};
    s.lights[1].twoSided = true;
    s.surfaces.push_back(sphere(Vector3d(1.0, -0.6, 0.5), 0.5, glossy(0.02)));
    out.push_back(
        named(s, "touching", "a light that stands on the ground and one that is two-sided", 50,
              "at the touching edge the light is seen under pi, where float32 has few digits left"));
    out.back().scene.lights[0].vertices = {Vector3d(0.4, 1.6, 0), Vector3d(1.8, 1.2, 0),
                                           Vector3d(1.8, 1.2, 1.6), Vector3d(0.4, 1.6, 1.6)};
  }
  {
    Scene s = groundAndSphere(glossy(0.15));
    s.surfaces.push_back(sphere(Vector3d(1.1, -0.4, 0.5), 0.5, glossy(0.5)));
    const std::pair<Vector3d, Vector3d> places[] = {{{0.6, 2.0, 1.4}, {1.0, 0.35, 0.2}},
                                                    {{-2.6, 0.8, 1.2}, {0.2, 0.8, 1.0}},
                                                    {{2.8, 0.2, 1.6}, {0.3, 1.0, 0.3}},
                                                    {{-0.4, -0.6, 3.2}, {0.9, 0.8, 0.6}}};
    for (const auto& [centre, colour] : places) {
      PolygonLight light =
          makeLight(LightShape::kQuad, centre, Vector3d(0, 0, 0.4) - centre, Vector2d(0.7, 0.5), 0.1);
      light.radiance = colour;
      s.lights.push_back(light);
    }
    out.push_back(named(s, "several-lights", "four coloured lights on three materials", 50, kRounding));
  }
  {
    Material m = glossy(0.0025);
    m.alphaEnd.setConstant(1.0);
    Scene s = rampUnderAWideLight(m);
    out.push_back(named(s, "ramp", "a plane whose roughness goes from 0.05 to 1", 50, kSharp));
  }
  {
    Scene s;
    s.camera.position = Vector3d(0, -6.0, 1.2);
    s.camera.target = Vector3d(0, 0, 0.7);
    s.camera.verticalFov = 0.45;
    const double roughness[] = {0.1, 0.2, 0.3, 0.4, 0.55, 0.7, 0.85, 1.0};
    for (int i = 0; i < 8; ++i) {
      const double r = roughness[i];
      s.surfaces.push_back(
          sphere(Vector3d(-1.5 + i % 4, i < 4 ? 0.6 : -0.4, i < 4 ? 1.15 : 0.25), 0.44, glossy(r * r)));
    }
    s.lights = {
        makeLight(LightShape::kQuad, Vector3d(0, -2.0, 3.0), Vector3d(0, 1.0, -1.2), Vector2d(1.8, 0.5)),
        makeLight(LightShape::kQuad, Vector3d(0, 2.4, 0.9), Vector3d(0, -1.0, 0), Vector2d(2.8, 0.4))};
    out.push_back(named(s, "spheres", "spheres of roughness 0.1 to 1 under a light above and one behind", 50,
                        kRounding));
  }
  {
    Scene s;
    s.camera.position = Vector3d(0, -6.0, 0.06);
    s.camera.target = Vector3d(0, 0, 0.02);
    s.camera.verticalFov = 0.25;
    s.surfaces = {ground(glossy(0.1), 5.0), sphere(Vector3d(-0.7, 0, 0.4), 0.4, glossy(0.25))};
    s.lights = {
        makeLight(LightShape::kQuad, Vector3d(0.3, 4.0, 0.5), Vector3d(0, -1, 0), Vector2d(1.2, 0.45))};
    out.push_back(
        named(s, "grazing", "the camera just above the ground: views of 88 to 89.8 degrees", 50, kRounding));
  }
  {
    Scene s = groundAndSphere(glossy(1e-4));
    s.surfaces[1].material = glossy(1e-3);
    s.lights = {backLight(LightShape::kQuad)};
    out.push_back(named(s, "mirror", "alpha 1e-4, the tables' floor, and a sphere of 1e-3", 40, kMirror));
  }
  {
    Scene s = groundAndSphere(glossy(1.0));
    s.lights = {backLight(LightShape::kQuad)};
    out.push_back(named(s, "rough", "alpha 1: as wide as lobes get", 50, kRounding));
  }
  return out;
}

std::vector<CheckScene> anisotropicScenes() {
  std::vector<CheckScene> out;
  {
    Scene s;
    s.camera.position = Vector3d(0, -6.0, 2.2);
    s.camera.target = Vector3d(0, 0, 0.9);
    s.camera.verticalFov = 0.6;
    for (int i = 0; i < 4; ++i)
      s.surfaces.push_back(
          sphere(Vector3d(-2.1 + 1.4 * i, 0, 0.65), 0.6, brushed(0.5, 0.05, kQuarterTurn * i / 3.0)));
    s.lights = {
        makeLight(LightShape::kQuad, Vector3d(0.5, -2.4, 3.2), Vector3d(-0.1, 1.0, -1.1), Vector2d(1.2, 0.5)),
        makeLight(LightShape::kQuad, Vector3d(0.0, 2.6, 1.4), Vector3d(0, -1.0, -0.2), Vector2d(2.2, 0.3))};
    out.push_back(named(s, "brushed-spheres",
                        "brushed spheres, tangents turned by 0, 30, 60 and 90 degrees; alpha 0.5 x 0.05", 50,
                        kRounding));
  }
  {
    Scene s = groundAndSphere(brushed(0.4, 0.08, 0.6));
    s.surfaces[1].material = brushed(0.06, 0.35);
    s.lights = {backLight(LightShape::kStar)};
    out.push_back(named(s, "brushed-star",
                        "a brushed plane and a sphere that is rougher across, under a star", 50, kRounding));
  }
  {
    Material m = brushed(0.04, 0.04, 0.4);
    m.alphaEnd = Vector2d(1.0, 0.04);
    Scene s = rampUnderAWideLight(m);
    out.push_back(named(s, "brushed-ramp", "a plane from isotropic to 25:1, alpha 0.04 across", 50, kSharp));
  }
  {
    Scene s = groundAndSphere(brushed(1.0, 0.01, 0.9));
    s.surfaces[1].material = brushed(0.01, 1.0);
    s.lights = {backLight(LightShape::kQuad)};
    out.push_back(named(s, "needles", "100:1, along and across", 50, kSharp));
  }
  {
    Scene s;
    s.camera.position = Vector3d(0, -6.0, 0.06);
    s.camera.target = Vector3d(0, 0, 0.02);
    s.camera.verticalFov = 0.25;
    s.surfaces = {ground(brushed(0.3, 0.03, 0.7), 5.0),
                  sphere(Vector3d(-0.7, 0, 0.4), 0.4, brushed(0.05, 0.5, 0.3))};
    s.lights = {
        makeLight(LightShape::kQuad, Vector3d(0.3, 4.0, 0.5), Vector3d(0, -1, 0), Vector2d(1.2, 0.45))};
    out.push_back(
        named(s, "brushed-grazing", "brushed surfaces at views of 88 to 89.8 degrees", 50, kRounding));
  }
  return out;
}

}  // namespace

std::vector<CheckScene> namedScenes(bool anisotropic) {
  std::vector<CheckScene> out = isotropicScenes();
  if (anisotropic) {
    std::vector<CheckScene> more = anisotropicScenes();
    out.insert(out.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
  return out;
}

Scene makeScene(const CustomScene& custom) {
  Scene scene = groundAndSphere(brushed(custom.alpha.x(), custom.alpha.y(), custom.angle));
  scene.lights = {backLight(custom.light)};
  scene.name = "custom";
  scene.title = "a plane and a sphere of one material under one light";
  return scene;
}

}  // namespace ltcfit
