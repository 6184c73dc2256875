// KTX2: Khronos' texture container, which WebGPU engines load.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "export/image.h"

namespace ltcfit {

/// A KTX2 file's image and its key/value pairs.
struct Ktx2File {
  Image image;
  std::vector<std::pair<std::string, std::string>> keyValues;  ///< values without their closing zero
};

enum class Ktx2Compression { kNone, kZstd };

/// One level, 2D, 2D array or volume; R, RG or RGBA, half or float (vkFormat 76, 83, 97, 100, 103, 109),
/// linear transfer, with the data format descriptor of the format; zstd supercompressed or not. Keys are
/// sorted and values closed by a zero, as the specification wants. Throws Refusal for other
/// images.
std::string imageToKtx2(const Ktx2File& file, Ktx2Compression compression);

bool isKtx2(std::string_view bytes);

/// Reads what imageToKtx2 writes, from any writer; the descriptor is not needed and not read. InputError with
/// `name` for anything else: other formats, more levels, cube maps, offsets outside of the file, sizes that
/// do not fit. Nothing is allocated for a claim that the file's length does not bear out.
Ktx2File parseKtx2(std::string_view bytes, const std::string& name);

/// A KTX2 file of a chain of mip maps and its key/value pairs.
struct Ktx2Mips {
  std::vector<Image> levels;  ///< from the finest on
  std::vector<std::pair<std::string, std::string>> keyValues;
};

/// A chain of mip maps (isMipChain), the coarsest first in the file as the specification wants, each level
/// compressed on its own. Throws std::invalid_argument for others.
std::string mipsToKtx2(const Ktx2Mips& file, Ktx2Compression compression);

/// Reads what mipsToKtx2 writes, from any writer; else InputError with `name`. Nothing is allocated for a
/// claim that the file's length does not bear out.
Ktx2Mips parseKtx2Mips(std::string_view bytes, const std::string& name);

}  // namespace ltcfit
