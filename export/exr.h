// OpenEXR: what image tools and offline renderers read.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "export/image.h"

namespace ltcfit {

/// One single-part scan-line file of named channels, all of one precision and size.
struct ExrFile {
  std::size_t width = 0;
  std::size_t height = 0;
  Precision precision = Precision::kFloat;
  std::vector<std::string> names;            ///< of the channels
  std::vector<std::vector<float>> channels;  ///< width * height numbers each, row by row from the top
  std::vector<std::pair<std::string, std::string>> attributes;  ///< of type string
};

/// ZIP-compressed. Throws std::invalid_argument for sizes that do not fit.
std::string channelsToExr(const ExrFile& file);

bool isExr(std::string_view bytes);

/// Reads half and float channels of a single-part scan-line file, uncompressed or of a lossless compression
/// (RLE, ZIP, PIZ), whose channels are not subsampled. InputError with `name` for anything else, damaged data
/// and sizes that the file's length cannot hold, before anything of that size is allocated.
ExrFile parseExr(std::string_view bytes, const std::string& name);

/// Reads channels R, G and B or, of a file without them, grey Y of a picture: as parseExr, but of any
/// compression, and with other channels, which are passed over. InputError with `name`, and how to convert
/// the file, for channels that are no such picture (luminance and chroma, CIE X, Y, Z) and a data window that
/// is not the display window.
ExrFile parseExrPicture(std::string_view bytes, const std::string& name);

/// A chain of mip maps of RGBA, down to one texel, and the file's attributes of type string.
struct ExrMips {
  std::vector<Image> levels;  ///< from the finest on
  std::vector<std::pair<std::string, std::string>> attributes;
};

/// Tiles of all levels, ZIP-compressed. Throws std::invalid_argument for a chain that is none (isMipChain) or
/// ends early: this format has no place for one.
std::string mipsToExr(const ExrMips& file);

/// Reads what mipsToExr writes: a single-part file of mip maps, their sizes rounded down, of half or float
/// channels R, G, B and A, its data window from the origin; losslessly compressed. InputError with `name` for
/// anything else, as parseExr.
ExrMips parseExrMips(std::string_view bytes, const std::string& name);

}  // namespace ltcfit
