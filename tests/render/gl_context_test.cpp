// The context without a window, and what is said where there is none to be had.
#include "render/gl_context.h"

#include <gtest/gtest.h>

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
