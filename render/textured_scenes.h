// Scenes with textured lights (Heitz et al. 2016, figures 11 and 12).
#pragma once

#include <vector>

#include "render/scenes.h"

namespace ltcfit {

/// A smooth picture and a checker, and the paper's failure cases: stained glass and a mask that makes a disk
/// of a rectangle. For every table.
std::vector<CheckScene> texturedScenes();

}  // namespace ltcfit
