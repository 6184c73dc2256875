// DDS: what DirectX and most engines load as a texture.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "export/image.h"

namespace ltcfit {

enum class DdsHeader {
  kLegacy,  ///< 128 bytes, FourCC of a D3D9 format (113: RGBA half, 116: RGBA float); no arrays
  kDx10,    ///< 148 bytes, DXGI format; arrays
};

/// One 2D texture, array (kDx10 only) or volume of 1, 2 or 4 components, no mip maps. Throws
/// Refusal for what the header cannot say.
std::string imageToDds(const Image& image, DdsHeader header);

bool isDds(std::string_view bytes);

/// Reads what imageToDds writes, of either header. InputError with `name` for anything else: other formats,
/// mip maps, cube maps, a length that is not what the header claims.
Image parseDds(std::string_view bytes, const std::string& name);

/// A chain of mip maps (isMipChain), with a DX10 header. Throws std::invalid_argument for others.
std::string mipsToDds(const std::vector<Image>& levels);

/// Reads what mipsToDds writes; InputError with `name` for anything else.
std::vector<Image> parseDdsMips(std::string_view bytes, const std::string& name);

}  // namespace ltcfit
