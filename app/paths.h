// What commands say of paths.
#pragma once

#include <filesystem>
#include <string>

namespace ltcfit::app {

/// The last part of a path: a name to print that says nothing of the machine.
inline std::string fileName(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

}  // namespace ltcfit::app
