#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "ggx/random.h"
#include "ltc/quad.h"
#include "render/scenes.h"

namespace ltcfit {
namespace {

double between(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

Material randomMaterial(Random& random, bool anisotropic) {
  Material m;
  if (!anisotropic) {
    const double roughness = between(random, 0.05, 1.0);
    m.alpha.setConstant(roughness * roughness);
    return m;
  }
  const double alpha = between(random, 0.03, 1.0);
  const double lambda = between(random, 0.05, 1.0);
  m.alpha = Eigen::Vector2d(alpha, lambda * alpha);
  if (random.uniform() < 0.5) m.alpha.reverseInPlace();
  m.rotation = between(random, 0.0, 2.0 * std::numbers::pi);
  return m;
}

PolygonLight randomLight(Random& random) {
  // the centre uniform over the directions of the upper hemisphere, facing the scene's middle but for a tilt
  const double z = random.uniform();
  const double azimuth = between(random, 0.0, 2.0 * std::numbers::pi);
  const double r = std::sqrt(1.0 - z * z);
  const Eigen::Vector3d direction(r * std::cos(azimuth), r * std::sin(azimuth), z);
  const Eigen::Vector3d centre = Eigen::Vector3d(0, 0, 0.5) + between(random, 1.5, 4.0) * direction;
  const std::array<Eigen::Vector3d, 2> across = tangents(direction);
  const double tilt = between(random, 0.0, 1.0);
  const double towards = between(random, 0.0, 2.0 * std::numbers::pi);
  const Eigen::Vector3d facing =
      -std::cos(tilt) * direction +
      std::sin(tilt) * (std::cos(towards) * across[0] + std::sin(towards) * across[1]);
  const double size = 0.7 * std::exp(0.7 * random.normal());
  const double aspect = std::exp(0.4 * random.normal());
  const double angle = between(random, 0.0, std::numbers::pi);
  return makeLight(LightShape::kQuad, centre, facing, Eigen::Vector2d(size * aspect, size / aspect), angle);
}

Camera randomCamera(Random& random, std::size_t size) {
  Camera camera;
  // elevation by its sine, from 2 degrees above the ground to nearly overhead
  const double sine = between(random, 0.035, 0.98);
  const double azimuth = between(random, 0.0, 2.0 * std::numbers::pi);
  const double distance = between(random, 4.0, 7.0);
  const double cosine = std::sqrt(1.0 - sine * sine);
  camera.target = Eigen::Vector3d(0, 0, 0.3);
  camera.position = distance * Eigen::Vector3d(cosine * std::cos(azimuth), cosine * std::sin(azimuth), sine);
  camera.width = size;
  camera.height = size;
  return camera;
}

// Part of the picture that shows a surface, of a coarse grid of rays.
double surfaceShare(Scene scene) {
  scene.camera.width = 12;
  scene.camera.height = 12;
  int hits = 0;
  for (std::size_t row = 0; row < 12; ++row)
    for (std::size_t column = 0; column < 12; ++column)
      if (viewPixel(scene, column, row).kind == PixelKind::kSurface) ++hits;
  return hits / 144.0;
}

Scene drawScene(Random random, bool anisotropic, std::size_t size) {
  Scene scene;
  Surface ground;
  ground.halfSize = Eigen::Vector2d(3, 3);
  ground.material = randomMaterial(random, anisotropic);
  Surface sphere;
  sphere.shape = SurfaceShape::kSphere;
  sphere.radius = between(random, 0.4, 0.9);
  sphere.centre = Eigen::Vector3d(0, 0, sphere.radius);
  sphere.material = ground.material;
  scene.surfaces = {ground, sphere};
  scene.lights = {randomLight(random)};
  scene.camera = randomCamera(random, size);
  return scene;
}

}  // namespace

Scene randomScene(std::uint64_t seed, std::uint64_t index, bool anisotropic, std::size_t size) {
  const std::uint64_t own = mixSeed(mixSeed(seed, anisotropic ? 2 : 1), index);
  Scene scene;
  // again where the light stands before the camera
  for (std::uint64_t attempt = 0; scene.surfaces.empty() || surfaceShare(scene) < 0.2; ++attempt)
    scene = drawScene(Random(mixSeed(own, attempt)), anisotropic, size);
  scene.name = fmt::format("random-{}-{}", anisotropic ? "aniso" : "iso", index);
  scene.title = "a random light, view and material";
  return scene;
}

}  // namespace ltcfit
