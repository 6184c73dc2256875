// Tables in source code and in the nameless binaries of engines.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ltc/table.h"

namespace ltcfit {

/// The table in a C header or JavaScript module (readTable lists which); nothing where the text holds none.
/// Without metadata the axes are those of the layout: of the 2017 or the 2022 table. InputError with `name`
/// for arrays that are one of these but do not fit together.
std::optional<Table> tableFromSource(std::string_view text, const std::string& name);

/// PlayCanvas' file (int16 0, int16 1, two float textures) and Babylon.js' (8 halves a texel), both 64 x 64
/// in the layout of 2017; nothing where the bytes are neither.
std::optional<Table> tableFromEngineBinary(std::string_view bytes, const std::string& name);

}  // namespace ltcfit
