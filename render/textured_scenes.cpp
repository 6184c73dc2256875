#include "render/textured_scenes.h"

#include <utility>

#include "render/light_textures.h"

namespace ltcfit {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t kTextureSize = 128;
constexpr std::uint64_t kGlassSeed = 1;

CheckScene textured(const char* name, const char* title, double alpha, LightTexture texture) {
  Scene s;
  s.name = name;
  s.title = title;
  s.camera.position = Vector3d(0.2, -4.6, 1.9);
  s.camera.target = Vector3d(0.1, 0.4, 0.75);
  Surface ground;
  ground.material.alpha.setConstant(alpha);
  Surface sphere;
  sphere.shape = SurfaceShape::kSphere;
  sphere.centre = Vector3d(-1.1, -0.2, 0.6);
  sphere.radius = 0.6;
  sphere.material = ground.material;
  s.surfaces = {ground, sphere};
  // upright, its top row above: vertices clockwise seen from the camera's side
  PolygonLight light;
  light.vertices = {Vector3d(-0.7, 1.6, 2.2), Vector3d(1.3, 1.6, 2.2), Vector3d(1.3, 1.6, 0.2),
                    Vector3d(-0.7, 1.6, 0.2)};
  light.texture = 0;
  s.lights = {light};
  s.textures = {std::move(texture)};
  return {std::move(s), 50.0, "texels are filtered in float32, at a level of detail of float32"};
}

}  // namespace

std::vector<CheckScene> texturedScenes() {
  return {textured("gradient", "a smooth picture as a light, alpha 0.1", 0.1, colourGradient(kTextureSize)),
          textured("checker", "a checker as a light on a glossy material, alpha 0.02", 0.02,
                   checker(kTextureSize, 6)),
          textured("stained-glass", "stained glass, which one isotropic filter cannot follow, alpha 0.16",
                   0.16, stainedGlass(kTextureSize, kGlassSeed)),
          textured("disk-mask",
                   "a disk made of a rectangle by its texture, alpha 0.16: the filter reads the "
                   "black around it",
                   0.16, diskMask(kTextureSize))};
}

}  // namespace ltcfit
