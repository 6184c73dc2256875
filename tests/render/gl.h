// Tests that draw: whether they can run here, and machines on which libraries are missing.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "render/gl_context.h"

namespace ltcfit::test {

/// Why there is no context on this machine; empty where there is one.
inline std::string glUnavailable() {
  try {
    const GlContext context;
    return {};
  } catch (const GlError& error) {
    return error.what();
  }
}

/// For death tests, whose processes are new ones: a library that was found once stays found.
class WithoutLibraries : public testing::Test {
 protected:
  WithoutLibraries() {
    std::string name = (std::filesystem::temp_directory_path() / "ltcfit-gl-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) ADD_FAILURE() << "no folder " << name;
    folder_ = name;
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    setenv("LD_LIBRARY_PATH", folder_.c_str(), 1);
  }
  ~WithoutLibraries() override {
    unsetenv("LD_LIBRARY_PATH");
    std::filesystem::remove_all(folder_);
  }

  // A file that is no library, found before the one that is.
  void hide(const char* library) { std::ofstream(folder_ / library) << "not a library"; }

  std::filesystem::path folder_;
};

}  // namespace ltcfit::test
