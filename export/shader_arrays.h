// A table as constant arrays in shader source, for programs that have no sampler to spare.
#pragma once

#include <string>

#include "export/packing.h"

namespace ltcfit {

enum class ShadingLanguage { kGlsl, kHlsl };

/// Text of an include file for GLSL 3.30, ES 3.00 and later, or HLSL of shader model 4 and later: an array of
/// vec4 (float4) for each texture of the packing, PREFIX_NAME[width * height * depth], float32 digits; and
/// its size. `prefix` becomes an identifier. No #version line.
std::string texturesToShader(const PackedTable& packed, const std::string& prefix, ShadingLanguage language);

}  // namespace ltcfit
