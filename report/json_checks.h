// What the readers of measurement files ask of fields. Every function throws InputError naming the field.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>

#include "export/json_fields.h"

namespace ltcfit {

void requireTexts(const JsonFields& fields, std::initializer_list<const char*> keys);

/// Numbers, or null for what could not be measured.
void requireFigures(const JsonFields& fields, std::initializer_list<const char*> keys);

/// Integers from 0 on.
void requireCounts(const JsonFields& fields, std::initializer_list<const char*> keys);

/// As requireCounts, and at least 1.
void requireSome(const JsonFields& fields, std::initializer_list<const char*> keys);

/// An object whose members are all counts.
void requireCountsByName(const JsonFields& fields, const char* key);

/// Of times in seconds: within 1e-9..1e6. Shorter is below what a clock tells apart, longer than anybody
/// waits.
void requireSeconds(const JsonFields& fields, const char* key);

/// Where both are numbers: that `less` is not above `more`.
void requireOrder(const JsonFields& fields, const char* less, const char* more);

void requireTruths(const JsonFields& fields, std::initializer_list<const char*> keys);

void requireNonEmpty(const JsonFields& fields, const char* key);

void requireOneOf(const JsonFields& fields, const char* key, std::initializer_list<std::string_view> names);

/// An object of numbers, texts and truths.
void requireOptions(const JsonFields& fields, const char* key);

/// "format" as given, "version" 1, "command" and "tool_version".
void requireFormat(const JsonFields& file, const char* format);

/// Calls `check` on every element of the array `key`, which are objects.
void forEach(const JsonFields& fields, const char* key, const std::function<void(const JsonFields&)>& check);

/// The file's JSON as it is, checked. Every message begins with `name`.
Json checkedJson(std::string_view text, const std::string& name,
                 const std::function<void(const JsonFields&)>& check);

}  // namespace ltcfit
