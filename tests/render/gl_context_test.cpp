// The context without a window, and what is said where there is none to be had.
#include "render/gl_context.h"

#include <epoxy/egl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "tests/render/gl.h"

namespace ltcfit::test {
namespace {

TEST(GlContext, SaysWhatItIsAndMayFollowAnother) {
  const std::string reason = glUnavailable();
  if (!reason.empty()) GTEST_SKIP() << reason;
  std::string name;
  {
    const GlContext first;
    name = glRendererName();
    EXPECT_NE(name.find(", "), std::string::npos);
    EXPECT_EQ(name.find("unknown"), std::string::npos) << name;
  }
  auto second = std::make_unique<GlContext>();
  const GlContext third;
  EXPECT_EQ(glRendererName(), name);
  second.reset();
  EXPECT_EQ(glRendererName(), name);
  std::printf("%s\n", name.c_str());
}

// Stands in for an EGL function, which epoxy calls through a pointer.
template <typename Function>
class Replaced {
 public:
  Replaced(Function& at, Function by) : at_(at), original_(at) { at_ = by; }
  ~Replaced() { at_ = original_; }
  Replaced(const Replaced&) = delete;
  Replaced& operator=(const Replaced&) = delete;

 private:
  Function& at_;
  Function original_;
};

// A machine of three devices, the first of which is software, where no display works.
namespace three_devices {

std::array<std::uintptr_t, 3> devices;

EGLBoolean queryDevices(EGLint most, EGLDeviceEXT* out, EGLint* count) {
  *count = std::min<EGLint>(most, devices.size());
  for (std::size_t i = 0; i < static_cast<std::size_t>(*count); ++i) out[i] = &devices[i];
  return EGL_TRUE;
}
const char* queryDeviceString(EGLDeviceEXT device, EGLint) {
  return device == &devices[0] ? "EGL_EXT_device_drm EGL_MESA_device_software" : "EGL_EXT_device_drm";
}
const char* queryString(EGLDisplay, EGLint) {
  return "EGL_EXT_platform_base EGL_MESA_platform_surfaceless EGL_EXT_platform_device "
         "EGL_EXT_device_enumeration EGL_EXT_device_query";
}
EGLDisplay platformDisplay(EGLenum platform, void* device, const EGLint*) {
  return platform == EGL_PLATFORM_DEVICE_EXT ? device : &devices;
}
EGLDisplay defaultDisplay(EGLNativeDisplayType) {
  return &devices;
}
EGLBoolean initialize(EGLDisplay, EGLint*, EGLint*) {
  return EGL_FALSE;
}

}  // namespace three_devices

TEST(GlContext, PrefersHardwareToMesasOwnPlatform) {
  const std::string reason = glUnavailable();
  if (!reason.empty()) GTEST_SKIP() << reason;
  const Replaced devices(epoxy_eglQueryDevicesEXT, three_devices::queryDevices);
  const Replaced deviceString(epoxy_eglQueryDeviceStringEXT, three_devices::queryDeviceString);
  const Replaced string(epoxy_eglQueryString, three_devices::queryString);
  const Replaced platform(epoxy_eglGetPlatformDisplayEXT, three_devices::platformDisplay);
  const Replaced fallback(epoxy_eglGetDisplay, three_devices::defaultDisplay);
  const Replaced initialize(epoxy_eglInitialize, three_devices::initialize);
  const std::string message = glUnavailable();
  std::size_t at = 0;
  for (const char* name :
       {"device 1: ", "device 2: ", "surfaceless platform: ", "device 0: ", "default display: "}) {
    const std::size_t found = message.find(name, at);
    ASSERT_NE(found, std::string::npos) << name << "in " << message;
    at = found;
  }
}

using GlContextDeathTest = WithoutLibraries;

[[noreturn]] void openContext() {
  try {
    const GlContext context;
  } catch (const GlError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::exit(1);
  }
  std::exit(0);
}

TEST_F(GlContextDeathTest, NamesWhatIsMissing) {
  ASSERT_EQ(setenv("__EGL_VENDOR_LIBRARY_DIRS", folder_.c_str(), 1), 0);
  EXPECT_EXIT(openContext(), testing::ExitedWithCode(1),
              "^OpenGL: no context without a window \\(tried .*EGL_.*install an OpenGL driver");
  unsetenv("__EGL_VENDOR_LIBRARY_DIRS");

  hide("libEGL.so.1");
  EXPECT_EXIT(openContext(), testing::ExitedWithCode(1),
              "^OpenGL: libEGL.so.1 is not on this machine; install");
  std::filesystem::remove(folder_ / "libEGL.so.1");
  for (const char* library : {"libOpenGL.so.0", "libGL.so.1", "libGLESv2.so.2"}) hide(library);
  EXPECT_EXIT(openContext(), testing::ExitedWithCode(1), "^OpenGL: none of libOpenGL.so.0, .* is on this");
}

}  // namespace
}  // namespace ltcfit::test
