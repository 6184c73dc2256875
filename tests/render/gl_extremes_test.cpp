// No pixel is NaN, negative or brighter than its lights, whatever the roughness, the light and the view.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "render/gl_renderer.h"
#include "render/scenes.h"
#include "tests/render/gl.h"

namespace ltcfit::test {
namespace {

using Eigen::Vector3d;

PolygonLight rectangle(const Vector3d& corner, const Vector3d& a, const Vector3d& b) {
  PolygonLight light;
  light.vertices = {corner, corner + a, corner + a + b, corner + b};
  light.twoSided = true;
  return light;
}

// Lights where integrals have their corners. The ground is z = 0.
std::vector<std::pair<const char*, PolygonLight>> hardLights() {
  return {
      {"standing on the ground", rectangle({-1, 0.5, 0}, {2, 0, 0}, {0, 0, 1.5})},
      {"lying in the ground", rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0})},
      {"a hair above the ground", rectangle({-1, -1, 1e-6}, {2, 0, 0}, {0, 2, 0})},
      {"through the ground", rectangle({-1, 0.5, -1}, {2, 0, 0.3}, {0.1, 0.2, 2})},
      {"through the sphere", rectangle({-1.5, 0.2, 0.3}, {1.4, 0, 0}, {0, 0, 0.8})},
      {"below the ground", rectangle({-1, 0.5, -2}, {2, 0, 0}, {0, 0, 1.5})},
      {"as large as the sky", rectangle({-1e4, -1e4, 5}, {2e4, 0, 0}, {0, 2e4, 0})},
      {"a needle", rectangle({-3, 1, 0.5}, {6, 0, 0}, {0, 0, 1e-5})},
      {"far away", rectangle({-1e5, 1e6, 1e5}, {2e5, 0, 0}, {0, 0, 2e5})},
      {"without extent", rectangle({0, 1, 1}, {0, 0, 0}, {0, 0, 0})},
  };
}

// Heights of the camera above the ground, from above to as low as float32 tells from 0.
constexpr double kHeights[] = {6.0, 0.5, 1e-2, 1e-4, 1e-6};

TEST(GlExtremes, EveryPixelIsALight) {
  const std::string reason = glUnavailable();
  if (!reason.empty()) GTEST_SKIP() << reason;
  const GlContext context;
  for (const char* const file : {"ltc_iso.json", "ltc_iso.ktx2", "ltc_aniso.json", "ltc_aniso.ktx2"}) {
    const ShaderTable table = loadShaderTable(std::string(LTCFIT_DATA_DIR) + "/" + file);
    GlRenderer renderer(table);
    std::size_t pixels = 0;
    std::size_t lit = 0;
    for (const double alpha : {1e-5, 1e-4, 3e-4, 1e-3, 0.01, 0.1, 0.4, 1.0}) {
      for (const double ratio : {1.0, 0.1, 0.01}) {
        if (ratio < 1.0 && table.isIsotropic()) continue;
        for (const auto& [name, light] : hardLights()) {
          for (const double height : kHeights) {
            Scene scene = makeScene({});
            for (Surface& s : scene.surfaces) s.material.alpha = Eigen::Vector2d(alpha, ratio * alpha);
            std::swap(scene.surfaces[1].material.alpha.x(), scene.surfaces[1].material.alpha.y());
            scene.surfaces[0].material.f0 = 0.04;
            scene.surfaces[0].material.diffuse = 0.5;
            scene.lights = {light};
            scene.camera.position = Vector3d(0.3, -3.0, height);
            scene.camera.target = Vector3d(0, 0, std::min(height, 0.3));
            scene.camera.width = 16;
            scene.camera.height = 12;
            const Film film = renderer.render(scene);
            for (std::size_t i = 0; i < film.radiance.size(); ++i) {
              if (film.kinds[i] != PixelKind::kSurface) continue;
              ++pixels;
              const Vector3d& v = film.radiance[i];
              ASSERT_TRUE(v.allFinite()) << file << ", alpha " << alpha << " x " << ratio << ", light "
                                         << name << ", height " << height << ", pixel " << i;
              ASSERT_GE(v.minCoeff(), 0.0) << file << " " << name;
              // f0 norm <= 1; on the ground diffuse 0.5 as well. Norms between nodes are good to some 0.02.
              ASSERT_LE(v.maxCoeff(), 1.55) << file << ", alpha " << alpha << ", light " << name;
              if (v.maxCoeff() > 1e-3) ++lit;
            }
          }
        }
      }
    }
    EXPECT_GT(pixels, 10000u) << file;
    EXPECT_GT(lit, pixels / 10) << file << ": most pictures are black";
  }
}

}  // namespace
}  // namespace ltcfit::test
