// Chains of mip maps: RGBA textures of two dimensions, each level half of the one before.
#pragma once

#include <cstddef>
#include <vector>

#include "export/image.h"

namespace ltcfit {

/// Levels of a texture of 16384 texels; no container here has more.
inline constexpr std::size_t kMaxLevels = 15;

/// `count` images without values: the first of the size and precision of `finest`, each next one of
/// max(1, half) of both sides, rounded down.
std::vector<Image> mipLevels(const Image& finest, std::size_t count);

/// Whether the images are such levels with their values: RGBA, of one precision, no more than down to one
/// texel.
bool isMipChain(const std::vector<Image>& levels);

}  // namespace ltcfit
