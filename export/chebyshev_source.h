// Decoders of the Chebyshev form in source code, each with the coefficients in it.
#pragma once

#include <string>

#include "export/shader_arrays.h"
#include "ltc/chebyshev_fit.h"

namespace ltcfit {

/// To be included after ltc.glsl or ltc.hlsl, whose LtcEntry it yields:
///   LtcEntry PREFIX_fetch(float roughness, float nDotV), without any texture or memory;
///   LtcEntry PREFIX_fetchCollapsed(vec4 shape[PREFIX_rows], vec2 amplitude[PREFIX_rows], float roughness,
///     float nDotV), where the sums over roughness have been done by the .js or .h file of the same form.
std::string chebyshevToShader(const ChebyshevForm& form, const ChebyshevDifference& difference,
                              const std::string& prefix, ShadingLanguage language);

/// C99 and C++: PREFIX_collapse, PREFIX_texel (one texel of the layout of 2017) and PREFIX_fill (both
/// textures of that layout, of any size).
std::string chebyshevToCHeader(const ChebyshevForm& form, const ChebyshevDifference& difference,
                               const std::string& prefix);

/// An ES module with the same three: collapse, texel, textures.
std::string chebyshevToModule(const ChebyshevForm& form, const ChebyshevDifference& difference);

}  // namespace ltcfit
