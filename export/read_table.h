// One door for every table that ltcfit can read.
#pragma once

#include <string>

#include "ltc/table.h"

namespace ltcfit {

/// Reads a table by its content, whatever its name says:
///   our JSON;
///   the published 2017 table as .npy or DDS (legacy header, half): `path` is its first texture (Minv), the
///   second one (norm, Fresnel) is looked for next to it, with the last '1' of the file name made a '2';
///   the published 2022 table as .npy.
/// Throws InputError: not there, not readable, not one of these, or damaged.
Table readTable(const std::string& path);

}  // namespace ltcfit
