// The C/C++ header of an anisotropic table, as the users of the 2022 table read it.
#pragma once

#include <string>

#include "ltc/table.h"

namespace ltcfit {

/// Text of a header with float arrays, alpha slowest, phi fastest:
///   NAME[alpha][lambda][theta][phi][9]            M row-major, unit third column,
///   NAME_amplitude[alpha][lambda][theta][phi][2]  (norm, Fresnel); [1] of a table that has one of these
///                                                 channels, none without.
/// The demo of 2022 and its users call the first `anisomats`. `name` becomes an identifier: other characters
/// are turned into '_'. Throws Refusal for an isotropic table or one without an inverse
/// somewhere.
std::string tableToAnisotropicCHeader(const Table& table, const std::string& name);

}  // namespace ltcfit
