// A window that shows scenes as the shading check draws them.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "export/png.h"
#include "render/scene.h"
#include "render/shader_table.h"

namespace ltcfit {

struct WindowOptions {
  std::size_t width = 960;
  std::size_t height = 720;
  int frames = 0;  ///< closes after so many; 0: when its user closes it
};

/// Keys and mouse, a line for each.
std::string_view windowHelp();

/// Shows the scenes, the first one first, until Escape or the window's own button. Values in force stand in
/// the title. Returns the last picture where `frames` says which one that is, else an empty one. Throws
/// GlError where there is no display or no OpenGL 3.3.
Picture showWindow(const ShaderTable& table, std::vector<Scene> scenes, const WindowOptions& options = {});

}  // namespace ltcfit
