// Tables without a description: what their numbers mean.
#pragma once

#include <string>
#include <vector>

#include "export/layouts.h"
#include "export/npy.h"
#include "export/packing.h"
#include "ltc/table.h"

namespace ltcfit {

/// The textures in a layout, `second` where the layout has one and it is there. x = sqrt(alpha), alpha =
/// max(x^2, 1e-5); theta <= 1.57: the parameters that the authors of 2017 fitted. InputError with `name` for
/// other sizes, and for a second texture given as the first.
PackedTable packedAs(const TableLayout& layout, const Image& first, const Image* second,
                     const std::string& name);

/// packedAs for the layout of 2017: (Minv00, Minv20, Minv02, Minv22) / Minv11 and norm, Fresnel. InputError
/// also for numbers that such a table does not have.
PackedTable packedFrom2017(const Image& first, const Image* second, const std::string& name);
Table tableFrom2017(const Image& first, const Image* second, const std::string& name);

/// The textures in the layout of this name; without a name in that of 2017, unless the numbers are not of it,
/// or make GGX lobes in another one and not in that (misfitOf), which is told in `notes`. InputError with
/// `name`: no such layout, other sizes, or numbers that make a table in none.
PackedTable packedUndescribed(const Image& first, const Image* second, const std::string& layout,
                              const std::string& name, std::vector<std::string>& notes);

/// The table of 2022: [alpha][lambda][theta][phi][3][3] of M, uniform axes, alpha_x and alpha_y >= 1e-4,
/// theta <= 0.9999 pi/2. InputError with `name` for other shapes.
Table tableFrom2022(const FloatArray& array, const std::string& name);

/// The names of the layouts of anisotropic arrays.
inline constexpr const char* kLayout2022 = "2022";
inline constexpr const char* kLayoutAlphas = "alpha_x-alpha_y";

/// Of the same shape with axes alpha_x and alpha_y: as the table of 2022 with values between its nodes of
/// alpha_y, as a shader of that array interpolates them. The first two axes have one length.
Table tableFromAlphas(const FloatArray& array, const std::string& name);

/// The array in the layout of this name ("2022", "alpha_x-alpha_y"); without a name in that of 2022, unless
/// it has the symmetry of the other one: swapping alpha_x and alpha_y, and x and y, mirrors phi. This is told
/// in `notes`. InputError with `name` for another layout or shape.
Table tableFromArray(const FloatArray& array, const std::string& layout, const std::string& name,
                     std::vector<std::string>& notes);

}  // namespace ltcfit
