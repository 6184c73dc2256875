// The Chebyshev form of a table as a file of its own: JSON with the coefficients, which are halves.
#pragma once

#include <string>
#include <string_view>

#include "ltc/chebyshev_fit.h"

namespace ltcfit {

/// What a coefficient costs where bytes are counted.
inline constexpr std::size_t kCoefficientBytes = 2;

/// A coefficient as the files hold it: the nearest half. Those below 6e-5 keep an absolute error of 3e-8.
double roundToHalfPrecision(double coefficient);

/// The file's text, with what the form differs by from the table it was made of.
std::string chebyshevToJson(const ChebyshevForm& form, const ChebyshevDifference& difference);

/// Whether a text claims to be such a file, damaged or not.
bool isChebyshevJson(std::string_view text);

/// Reads it; the stated difference is not looked at. Throws InputError naming file and field for anything
/// else, a coefficient that is no half, and whatever checkChebyshev refuses.
ChebyshevForm chebyshevFromJson(std::string_view text, const std::string& name);

}  // namespace ltcfit
