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

}  // namespace ltcfit
