// Textured lights as OpenGL draws them against the twin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

#include "render/gl_renderer.h"
#include "render/light_textures.h"
#include "render/picture_error.h"
#include "render/scenes.h"
#include "render/twin.h"
#include "tests/render/gl.h"

namespace ltcfit::test {
namespace {

// A plane and a sphere with a base that is not black under three rectangles, two of them textured.
Scene texturedScene() {
  Scene scene = makeScene({});
  scene.name = "textured";
  for (Surface& s : scene.surfaces) {
    s.material.f0 = 0.6;
    s.material.diffuse = 0.3;
  }
  scene.lights.push_back(makeLight(LightShape::kQuad, Eigen::Vector3d(-1.5, 0.5, 1.5),
                                   Eigen::Vector3d(0.6, -0.2, -0.8), Eigen::Vector2d(0.8, 0.5), 0.3));
  scene.lights.push_back(scene.lights.back());
  for (Eigen::Vector3d& v : scene.lights[2].vertices) v += Eigen::Vector3d(0.5, -1.5, 0.4);
  scene.lights[0].texture = 1;
  scene.lights[1].texture = 0;
  scene.textures = {stainedGlass(64, 5), colourGradient(32)};
  scene.camera.width = 120;
  scene.camera.height = 90;
  return scene;
}

std::vector<PrefilteredTexture> textures() {
  std::vector<PrefilteredTexture> out;
  for (const LightTexture& picture : texturedScene().textures) out.push_back(prefilter(picture, {}));
  return out;
}

TEST(GlTextured, AgreesWithTheTwin) {
  if (const std::string reason = glUnavailable(); !reason.empty()) GTEST_SKIP() << reason;
  const GlContext context;
  const ShaderTable table = loadShaderTable(std::string(LTCFIT_DATA_DIR) + "/ltc_aniso.json");
  const std::vector<PrefilteredTexture> pictures = textures();
  GlRenderer renderer(table);
  renderer.useTextures(pictures);
  const Scene scene = texturedScene();
  TwinOptions options;
  options.textures = pictures;
  const Film twin = renderTwin(scene, table.table, options);
  const PictureError error = pictureError(renderer.render(scene), twin);
  std::printf("  %.1f dB, largest %.1e\n", error.psnr, error.largest);
  // float32 of u, v and the level move the look-up by about 1e-5 of a texel
  EXPECT_GT(error.psnr, 90.0);
  EXPECT_EQ(error.nonFinite, 0u);

  // the colours are seen: the other way around, turned by a quarter, or white they are off
  renderer.useTextures({pictures[1], pictures[0]});
  EXPECT_LT(pictureError(renderer.render(scene), twin).psnr, 50.0);
  renderer.useTextures(pictures);
  Scene turned = scene;
  std::rotate(turned.lights[0].vertices.begin(), turned.lights[0].vertices.begin() + 1,
              turned.lights[0].vertices.end());
  EXPECT_LT(pictureError(renderer.render(turned), twin).psnr, 50.0);
  Scene white = scene;
  for (PolygonLight& light : white.lights) light.texture = -1;
  EXPECT_LT(pictureError(renderer.render(white), twin).psnr, 50.0);
}

TEST(GlTextured, RefusesWhatWasNotGiven) {
  if (const std::string reason = glUnavailable(); !reason.empty()) GTEST_SKIP() << reason;
  const GlContext context;
  GlRenderer renderer(loadShaderTable(std::string(LTCFIT_DATA_DIR) + "/ltc_iso.json"));
  Scene scene = texturedScene();
  EXPECT_THROW(renderer.render(scene), std::invalid_argument);
  const PrefilteredTexture small = prefilter(colourGradient(4), {});
  renderer.useTextures({small, small});
  EXPECT_NO_THROW(renderer.render(scene));
  EXPECT_THROW(renderer.useTextures({small, small, small, small, small}), std::invalid_argument);
  scene.lights[0].vertices.pop_back();
  EXPECT_THROW(renderer.render(scene), std::invalid_argument);
}

}  // namespace
}  // namespace ltcfit::test
