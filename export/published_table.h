// The published tables: what their numbers mean.
#pragma once

#include <string>

#include "export/npy.h"
#include "export/packing.h"
#include "ltc/table.h"

namespace ltcfit {

/// The table of 2017, and what engines made of it: `first` is (Minv00, Minv20, Minv02, Minv22) / Minv11,
/// `second`, if any, holds norm and Fresnel in its first two components. x = sqrt(alpha), alpha = max(x^2,
/// 1e-5); y = sqrt(1 - cos theta), theta <= 1.57: the parameters that its authors fitted. InputError with
/// `name` for other sizes.
PackedTable packedFrom2017(const Image& first, const Image* second, const std::string& name);
Table tableFrom2017(const Image& first, const Image* second, const std::string& name);

/// The table of 2022: [alpha][lambda][theta][phi][3][3] of M, uniform axes, alpha_x and alpha_y >= 1e-4,
/// theta <= 0.9999 pi/2. InputError with `name` for other shapes.
Table tableFrom2022(const FloatArray& array, const std::string& name);

}  // namespace ltcfit
