// Tables in source code and in the nameless binaries of engines.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "export/image.h"
#include "ltc/table.h"

namespace ltcfit {

/// What a text of source code or JSON holds of a table: at most one of the two.
struct SourceContents {
  std::optional<Table> table;  ///< described by the file, or in the layout of 2022
  std::vector<Image>
      textures;  ///< without a description: the matrices, and norm and Fresnel if they are there
  std::vector<std::string> names;  ///< of the textures' arrays
  std::string arrays;              ///< all arrays found, "a (64 numbers), b (32)"; empty without any
};

/// Finds the arrays of a table, whatever their names are: one of 4 numbers a texel, square unless its shape
/// tells more, and one of 2 to 4 numbers for the same texels. Where several pairs fit by size, that counts
/// which is a table of 2017 by its numbers, then the one whose names engines use (LTC_MAT_1 and LTC_MAT_2,
/// ltc_1, ltc_mat and ltc_amp, ..), then the one in order. Integers up to 65535, of which one is at least
/// 0x3000, are taken for the bits of halves. Matrices alone are found where `isFirstOfTwo`, or where the name
/// is one of files that hold no more. InputError with `name` for arrays that broke off, do not fit together,
/// or more pairs than one.
SourceContents contentsOfSource(std::string_view text, const std::string& name, bool isFirstOfTwo = false);

/// The array of norm and Fresnel alone, for the texels of `first`: the only one that fits by size, or by its
/// name. InputError with `name`.
Image amplitudesOfSource(std::string_view text, const Image& first, const std::string& name);

/// The table in a text, in the layout of 2017 where it has no description; nothing where the text holds none.
std::optional<Table> tableFromSource(std::string_view text, const std::string& name);

/// PlayCanvas' file (int16 0, int16 1, two float textures) and Babylon.js' (8 halves a texel), both 64 x 64
/// in the layout of 2017; nothing where the bytes are neither.
std::optional<Table> tableFromEngineBinary(std::string_view bytes, const std::string& name);

}  // namespace ltcfit
