// Readers for the published tables: .npy and DDS, and what their numbers mean.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "ltc/table.h"

namespace ltcfit {

/// An array as a file holds it, last index fastest.
struct FloatArray {
  std::vector<std::size_t> shape;
  std::vector<float> values;
};

bool isNpy(std::string_view bytes);
bool isDds(std::string_view bytes);

/// NumPy's format, versions 1 to 3, little-endian float32 in C order. InputError for anything else and for a
/// length that does not fit the shape.
FloatArray parseNpy(std::string_view bytes, const std::string& name);

/// A legacy DDS header (128 bytes) with FourCC 113 (RGBA half) and one 2D image: shape {height, width, 4}.
FloatArray parseDds(std::string_view bytes, const std::string& name);

/// The table of 2017: `first` is [y][x][4] = (Minv00, Minv20, Minv02, Minv22) / Minv11, `second`, if any,
/// holds norm and Fresnel in its first two channels. x = sqrt(alpha), alpha = max(x^2, 1e-5); y = sqrt(1 -
/// cos theta), theta <= 1.57: the parameters that its authors fitted.
Table tableFrom2017(const FloatArray& first, const FloatArray* second, const std::string& name);

/// The table of 2022: [alpha][lambda][theta][phi][3][3] of M, uniform axes, alpha_x and alpha_y >= 1e-4,
/// theta <= 0.9999 pi/2.
Table tableFrom2022(const FloatArray& array, const std::string& name);

}  // namespace ltcfit
