// The option --axes of ltcfit fit: where the nodes of a table lie.
#pragma once

#include <string>

#include "fit/node_placement.h"

namespace ltcfit::app {

/// The default.
inline constexpr const char* kIsotropicAxes = "2017";
inline constexpr const char* kAnisotropicAxes = "2022";

/// A name (isotropicPlacement, anisotropicPlacement), or a list of axes that differ from the default, each
/// NAME=MAP, NAME=MAP:A, NAME=MAP:A:B (the coefficients of AxisWarp) or NAME=knots:V0:V1:... (degrees for
/// angles), separated by commas. Throws InputError with a message that names the option and what
/// is wrong; whether map, warp and knots suit the axis is up to placedAxis.
IsotropicPlacement parseIsotropicAxes(const std::string& text);
AnisotropicPlacement parseAnisotropicAxes(const std::string& text);

}  // namespace ltcfit::app
