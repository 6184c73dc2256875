// NumPy's array file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "export/image.h"

namespace ltcfit {

/// An array as a file holds it, last index fastest.
struct FloatArray {
  std::vector<std::size_t> shape;
  std::vector<float> values;
};

/// Version 1.0, C order, '<f4' or '<f2'.
std::string arrayToNpy(const FloatArray& array, Precision precision);

bool isNpy(std::string_view bytes);

/// Versions 1 to 3: float16, float32 or float64, of either byte order, in C or Fortran order. Numbers are
/// rounded to the nearest float32, and come in C order. InputError for anything else, for a length that does
/// not fit the shape, and for a finite float64 beyond float32, naming its indices.
FloatArray parseNpy(std::string_view bytes, const std::string& name);

}  // namespace ltcfit
