// The window: without a display a message; with one (tests/render/CMakeLists.txt brings Xvfb) the picture.
#include "render/window.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "render/scenes.h"
#include "render/twin.h"
#include "tests/render/gl.h"

namespace ltcfit::test {
namespace {

ShaderTable table() {
  return loadShaderTable(std::string(LTCFIT_DATA_DIR) + "/ltc_iso.json");
}

TEST(Window, ShowsWhatTheTwinSees) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display";
  Scene scene = makeScene({});
  WindowOptions options;
  options.width = 200;
  options.height = 150;
  options.frames = 3;
  const ShaderTable shaderTable = table();
  const Picture picture = showWindow(shaderTable, {scene}, options);
  ASSERT_EQ(picture.rgb.size(), picture.width * picture.height * 3);
  scene.camera.width = picture.width;
  scene.camera.height = picture.height;
  const Film film = renderTwin(scene, shaderTable.table);
  std::size_t off = 0;
  for (std::size_t i = 0; i < film.radiance.size(); ++i) {
    const double c = std::clamp(film.radiance[i].x(), 0.0, 1.0);
    const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
    // rounding to 8 bits, and float32 beside it
    if (std::abs(255.0 * encoded - picture.rgb[3 * i]) > 0.6) ++off;
  }
  EXPECT_EQ(off, 0u);
  // a second one follows the first
  EXPECT_EQ(showWindow(shaderTable, {scene}, options).rgb, picture.rgb);
}

TEST(Window, SaysThatThereIsNoDisplay) {
  const char* const display = std::getenv("DISPLAY");
  const std::string was = display == nullptr ? "" : display;
  setenv("DISPLAY", ":4711", 1);
  const ShaderTable shaderTable = table();
  try {
    showWindow(shaderTable, {makeScene({})}, {});
    ADD_FAILURE() << "opened";
  } catch (const GlError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("cannot open a display"), std::string::npos) << message;
    EXPECT_NE(message.find("without --window"), std::string::npos) << message;
  }
  if (display == nullptr) {
    unsetenv("DISPLAY");
  } else {
    setenv("DISPLAY", was.c_str(), 1);
  }
}

}  // namespace
}  // namespace ltcfit::test
