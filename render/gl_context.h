// OpenGL without a window.
#pragma once

#include <stdexcept>
#include <string>

namespace ltcfit {

/// OpenGL is not there, cannot do what is needed, or failed: a message for the user. Exit code 1.
class GlError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A context of OpenGL 3.3 core or later, or of OpenGL ES 3.0 or later where that is all there is, made by
/// EGL and current in the thread that made it, without a surface to draw on (framebuffer objects only).
/// Displays tried: EGL devices that are hardware, Mesa's surfaceless platform, all other EGL devices, the
/// default display. Any number may follow or overlap each other.
class GlContext {
 public:
  /// Throws GlError that says what was tried, what failed and what to install. The libraries themselves are
  /// looked for here: a program that links this starts without them.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

 private:
  std::string open(void* display);

  void* display_ = nullptr;
  void* context_ = nullptr;
  void* surface_ = nullptr;
};

/// Renderer and version of the current context, as it names itself.
std::string glRendererName();

}  // namespace ltcfit
