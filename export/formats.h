// Every format that `ltcfit export --format` knows.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "export/texture_files.h"
#include "ltc/chebyshev_fit.h"

namespace ltcfit {

/// Which numbers go into a file of textures.
enum class Layout {
  kPacked,    ///< as shaders read them: packing2017 or packingOfRows
  kChannels,  ///< every channel as the table stores it
  kLean,      ///< packingLean: as shaders read it, without what the table lacks
};

struct FormatOptions {
  Layout layout = Layout::kPacked;
  Precision precision = Precision::kFloat;
  DdsHeader ddsHeader = DdsHeader::kDx10;
  Ktx2Compression ktx2Compression = Ktx2Compression::kZstd;
  std::string prefix;                  ///< of identifiers in source files; empty for the default
  std::size_t coefficientBytes = 320;  ///< of the Chebyshev form; 160 halves
};

/// What a format can do, for messages and lists.
struct FormatInfo {
  std::string_view name;
  std::string_view extension;
  std::string_view contents;  ///< for `ltcfit export --list`
  bool half = false;          ///< can hold halves
  bool layouts = false;       ///< can hold every layout
  bool prefix = false;        ///< holds identifiers
  Layout standard = Layout::kPacked;
};

/// "packed", "channels", "lean"; back: Refusal for others.
std::string_view layoutName(Layout layout);
Layout layoutFromName(std::string_view name);

const std::vector<FormatInfo>& formats();

/// The format of that name; nullptr for none.
const FormatInfo* findFormat(std::string_view name);

/// The files of an export, the one asked for first, and what there is to say about them.
struct ExportResult {
  std::vector<ExportFile> files;
  std::vector<std::string> warnings;
  HalfReport half;
  std::optional<ChebyshevDifference> chebyshev;
  std::optional<Table> table;  ///< what was written, where that is not the table given (resampled, expanded)
};

/// `name` is the file's, without folder. Throws Refusal for options that the format does not
/// have and tables that it has no place for.
ExportResult exportTable(const Table& table, const FormatInfo& format, const FormatOptions& options,
                         const std::string& name);

}  // namespace ltcfit
