// The C/C++ header: texture-ready arrays with their conventions in a comment.
#pragma once

#include <string>

#include "ltc/table.h"

namespace ltcfit {

/// Text of a header with two float arrays for an isotropic table, row-major, theta slowest:
///   PREFIX_matrix[N][4]    (Minv00, Minv20, Minv02, Minv22) / Minv11, as the engines' shaders read them,
///   PREFIX_amplitude[N][2] (norm, Fresnel); [1] of a table that has one of these channels, none without.
/// `prefix` becomes part of C identifiers; every other character is turned into '_'. Plain C89 apart from the
/// comment, floats with 9 significant digits. Throws Refusal for an anisotropic table or one
/// with matrix entries off the x-z plane, and for an entry without an inverse.
std::string tableToCHeader(const Table& table, const std::string& prefix);

}  // namespace ltcfit
