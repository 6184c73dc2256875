// The table file: JSON, version 1. The form that every part of ltcfit reads and writes.
#pragma once

#include <string>
#include <string_view>

#include "ltc/table.h"

namespace ltcfit {

/// The file's text. Numbers read back to the same float32 (data) and double (axes); nothing in it depends on
/// time or machine.
std::string tableToJson(const Table& table);

/// Reads it. `name` is the file's, for messages. Throws InputError naming the field for text that is not
/// JSON, another format or version, a missing or wrong field, and whatever Table's constructor refuses.
Table tableFromJson(std::string_view text, const std::string& name);

/// InputError with `name` for text that is no JSON at all.
void checkJson(std::string_view text, const std::string& name);

}  // namespace ltcfit
