// The colour scales of the pictures.
#pragma once

#include <array>
#include <cstdint>

namespace ltcfit {

using Rgb = std::array<std::uint8_t, 3>;

/// Densities: dark violet over green to yellow, evenly brighter, for t in [0, 1] (clamped): nine colours of
/// viridis (van der Walt and Smith) and straight lines between them.
Rgb densityColor(double t);

/// Differences: blue below, neutral grey at 0, orange above, for t in [-1, 1] (clamped).
Rgb differenceColor(double t);

}  // namespace ltcfit
