// Prefiltered textures between their numbers in double and those of a file.
#pragma once

#include "export/light_texture.h"
#include "render/prefilter.h"

namespace ltcfit {

/// Rounded to the precision. Throws Refusal for values that it cannot hold.
LightTextureFile toLightTextureFile(const PrefilteredTexture& texture, Precision precision);

/// The numbers as the file has them.
PrefilteredTexture fromLightTextureFile(const LightTextureFile& file);

}  // namespace ltcfit
