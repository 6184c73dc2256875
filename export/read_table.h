// One door for every table that ltcfit can read.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "export/packing.h"
#include "ltc/table.h"

namespace ltcfit {

/// What a file does not tell, as the user tells it; empty: as the file's content and name suggest.
struct ReadOptions {
  std::string second;  ///< path of the second texture (norm, Fresnel) of a table in two files
  std::string layout;  ///< name of the layout of a table without a description
};

/// Reads a table by its content, whatever its name says:
///   our JSON;
///   our Chebyshev form (.cheb.json), as the table of tableOfChebyshev;
///   what `ltcfit export` writes as KTX2, EXR, DDS, .npy or raw numbers, with the metadata in the file or in
///   FILE.json beside it; metadata beside a file count only with the checksum of that file;
///   the layout of 2017 without metadata, as engines ship it (numbers that such a table does not have are
///   refused): .npy, DDS or KTX2 (one file of two layers, or the first of two files: the second one is that
///   of ReadOptions, else secondTextureBeside, which a note tells), PlayCanvas' and Babylon.js' binaries;
///   source code with the arrays of a table (contentsOfSource): C, C++, C#, JavaScript, TypeScript, Rust; a
///   JSON object with them; the second one may be in another file, as of textures. Headers of 2022 have an
///   array of five dimensions, 9 numbers last;
///   the published 2022 table as .npy.
/// Throws InputError: not there, not readable, not one of these, or damaged; `second` for a file that needs
/// none, or of another size.
Table readTable(const std::string& path, const ReadOptions& options = {});

/// The same with what the file holds, for who hands its textures on.
struct TableFile {
  Table table;
  std::string format;  ///< "KTX2", "DDS", "EXR", ".npy", "JSON", "Chebyshev form", "binary", "source code"
  std::optional<PackedTable> textures;  ///< as they lie in the file; nothing where it holds a table or code
  std::vector<std::string> notes;       ///< what was taken without being told, for the user: a sentence each
};
TableFile readTableFile(const std::string& path, const ReadOptions& options = {});

/// The files that reading this one may take: itself, its description, the second texture. What must not be
/// written over while it is read.
std::vector<std::string> filesOfTable(const std::string& path, const ReadOptions& options = {});

}  // namespace ltcfit
