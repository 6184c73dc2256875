#include "render/window.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "render/gl_context.h"
#include "render/gl_renderer.h"
#include "render/viewer.h"

namespace ltcfit {
namespace {

[[noreturn]] void fail(const char* what) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  throw GlError(fmt::format("{} ({}); without --window the check needs no display", what,
                            reason == nullptr ? "no reason given" : reason));
}

struct GlfwLibrary {
  GlfwLibrary() {
    if (glfwInit() == GLFW_FALSE) fail("cannot open a display for a window");
  }
  ~GlfwLibrary() { glfwTerminate(); }
  GlfwLibrary(const GlfwLibrary&) = delete;
  GlfwLibrary& operator=(const GlfwLibrary&) = delete;
};

using Window = std::unique_ptr<GLFWwindow, decltype(&glfwDestroyWindow)>;

// What the callbacks of a window change.
struct State {
  Viewer viewer;
  bool changed = true;
  bool dragging = false;
  double x = 0.0;
  double y = 0.0;
};

State& stateOf(GLFWwindow* window) {
  return *static_cast<State*>(glfwGetWindowUserPointer(window));
}

struct Key {
  int key;
  ViewerAction action;
};
constexpr std::array<Key, 12> kKeys{{{GLFW_KEY_UP, ViewerAction::kRougher},
                                     {GLFW_KEY_DOWN, ViewerAction::kSmoother},
                                     {GLFW_KEY_X, ViewerAction::kMoreAnisotropic},
                                     {GLFW_KEY_Y, ViewerAction::kLessAnisotropic},
                                     {GLFW_KEY_LEFT, ViewerAction::kTurnLeft},
                                     {GLFW_KEY_RIGHT, ViewerAction::kTurnRight},
                                     {GLFW_KEY_PAGE_UP, ViewerAction::kLargerLights},
                                     {GLFW_KEY_PAGE_DOWN, ViewerAction::kSmallerLights},
                                     {GLFW_KEY_L, ViewerAction::kNextLight},
                                     {GLFW_KEY_SPACE, ViewerAction::kNextScene},
                                     {GLFW_KEY_BACKSPACE, ViewerAction::kPreviousScene},
                                     {GLFW_KEY_HOME, ViewerAction::kReset}}};

void onKey(GLFWwindow* window, int key, int, int action, int) {
  if (action == GLFW_RELEASE) return;
  if (key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(window, GLFW_TRUE);
  State& state = stateOf(window);
  for (const Key& k : kKeys) {
    if (k.key != key) continue;
    state.viewer.apply(k.action);
    state.changed = true;
  }
}

void onButton(GLFWwindow* window, int button, int action, int) {
  if (button != GLFW_MOUSE_BUTTON_LEFT) return;
  State& state = stateOf(window);
  state.dragging = action == GLFW_PRESS;
  glfwGetCursorPos(window, &state.x, &state.y);
}

void onMove(GLFWwindow* window, double x, double y) {
  State& state = stateOf(window);
  if (!state.dragging) return;
  constexpr double kRadiansPerPixel = 0.006;
  // the scene follows the hand: the camera goes the other way
  state.viewer.orbit((state.x - x) * kRadiansPerPixel, (y - state.y) * kRadiansPerPixel);
  state.x = x;
  state.y = y;
  state.changed = true;
}

void onScroll(GLFWwindow* window, double, double steps) {
  stateOf(window).viewer.zoom(steps);
  stateOf(window).changed = true;
}

void onDamage(GLFWwindow* window) {
  stateOf(window).changed = true;
}

Window openWindow(const WindowOptions& options) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  Window window(glfwCreateWindow(static_cast<int>(options.width), static_cast<int>(options.height), "ltcfit",
                                 nullptr, nullptr),
                glfwDestroyWindow);
  if (!window) fail("cannot open a window with OpenGL 3.3");
  glfwMakeContextCurrent(window.get());
  return window;
}

// The back buffer, before it is shown.
Picture drawnPicture(std::size_t width, std::size_t height) {
  std::vector<std::uint8_t> pixels(width * height * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadBuffer(GL_BACK);
  glReadPixels(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height), GL_RGBA, GL_UNSIGNED_BYTE,
               pixels.data());
  checkGl("reading the window's picture");
  Picture picture{width, height, {}};
  picture.rgb.reserve(width * height * 3);
  for (std::size_t row = height; row-- > 0;) {
    for (std::size_t i = row * width; i < (row + 1) * width; ++i)
      picture.rgb.insert(picture.rgb.end(), {pixels[4 * i], pixels[4 * i + 1], pixels[4 * i + 2]});
  }
  return picture;
}

}  // namespace

std::string_view windowHelp() {
  return "drag              turn about the scene\n"
         "wheel             nearer, farther\n"
         "up, down          rougher, smoother (alpha by a quarter octave)\n"
         "X, Y              rougher along the tangent, across it (anisotropic tables)\n"
         "left, right       turn the tangents by 5 degrees\n"
         "page up, down     larger, smaller lights\n"
         "L                 lights as in the scene, quads, stars, disks\n"
         "space, backspace  next scene, previous one\n"
         "home              as it was\n"
         "escape            close\n";
}

Picture showWindow(const ShaderTable& table, std::vector<Scene> scenes, const WindowOptions& options) {
  const GlfwLibrary library;
  const Window window = openWindow(options);
  State state{Viewer(std::move(scenes), table.isIsotropic())};
  glfwSetWindowUserPointer(window.get(), &state);
  glfwSetKeyCallback(window.get(), onKey);
  glfwSetMouseButtonCallback(window.get(), onButton);
  glfwSetCursorPosCallback(window.get(), onMove);
  glfwSetScrollCallback(window.get(), onScroll);
  glfwSetWindowRefreshCallback(window.get(), onDamage);
  GlRenderer renderer(table);
  const std::string name = glRendererName();
  std::string textured;  // the scene whose textures the renderer has
  Picture picture;
  for (int frame = 0; glfwWindowShouldClose(window.get()) == GLFW_FALSE;) {
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(window.get(), &width, &height);
    if (width > 0 && height > 0 && (state.changed || options.frames > 0)) {
      state.changed = false;
      const auto begin = std::chrono::steady_clock::now();
      const auto w = static_cast<std::size_t>(width);
      const auto h = static_cast<std::size_t>(height);
      const Scene scene = state.viewer.scene(w, h);
      if (scene.name != textured) {
        std::vector<PrefilteredTexture> textures;
        for (const LightTexture& t : scene.textures) textures.push_back(prefilter(t, {}));
        renderer.useTextures(textures);
        textured = scene.name;
      }
      renderer.drawForDisplay(scene, w, h);
      glFinish();
      const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
      ++frame;
      if (frame == options.frames) picture = drawnPicture(w, h);
      glfwSwapBuffers(window.get());
      glfwSetWindowTitle(window.get(),
                         fmt::format("{}; {:.1f} ms, {}", state.viewer.title(), took.count(), name).c_str());
      if (frame == options.frames) break;
    }
    if (options.frames > 0) {
      glfwPollEvents();
    } else {
      glfwWaitEvents();
    }
  }
  return picture;
}

}  // namespace ltcfit
