// What the decoders of the Chebyshev form have in common.
#pragma once

#include <string>
#include <vector>

#include "ltc/chebyshev_fit.h"

namespace ltcfit {

/// The number of rows of the longest function, 1 at least.
std::size_t rowCount(const ChebyshevForm& form);
/// Lines for a comment: what it is, who made it, how far it is from its table, the frame.
std::vector<std::string> describeChebyshev(const ChebyshevForm& form, const ChebyshevDifference& difference);
/// Lines for a comment about the textures that the C and JavaScript decoders fill.
const std::vector<std::string>& describeTexels();
/// The lines, each after `start` and a blank.
std::string commented(const std::vector<std::string>& lines, const char* start);
/// The smallest roughness, as a literal without a suffix.
std::string literalOfSmallestRoughness(const ChebyshevForm& form);

}  // namespace ltcfit
