// The file of norm and Fresnel beside that of the matrices.
#pragma once

#include <optional>
#include <string>

namespace ltcfit {

/// The file in the same folder whose name is that of `path` with a part exchanged, as engines name the two
/// textures of a table: ltc_mat and ltc_amp or ltc_mag, LtcMat and LtcAmp, matrix and amplitude or magnitude,
/// table-1 and table-2 (the last '1'), "rgba" and "rg" with it. Where several are there, the first in this
/// order; nothing where none is.
std::optional<std::string> secondTextureBeside(const std::string& path);

}  // namespace ltcfit
