// Pictures for textured lights, made by formulas: easy ones, and those that prefiltering fails on.
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/scene.h"

namespace ltcfit {

/// Radiance 0..1, `size` x `size` texels; edges are smoothed over one texel. `size` > 0.

/// Smooth: red grows along u, green down v, blue against both.
LightTexture colourGradient(std::size_t size);
/// Cells around random points, each of one saturated colour, between dark lead lines.
LightTexture stainedGlass(std::size_t size, std::uint64_t seed);
/// A white disk of radius 0.35 in the middle of black.
LightTexture diskMask(std::size_t size);
/// `squares` x `squares` squares, warm white and dark blue in turn.
LightTexture checker(std::size_t size, std::size_t squares);

}  // namespace ltcfit
