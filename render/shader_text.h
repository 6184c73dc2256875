// The shaders of render/shaders/, as they lie in the program: the very text that users include.
#pragma once

#include <string_view>

namespace ltcfit {

/// Text of a file of render/shaders/, by its name ("ltc.glsl"). A name that is not there is a caller's bug
/// and aborts.
std::string_view shaderText(std::string_view name);

}  // namespace ltcfit
