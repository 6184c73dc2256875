#include "report/json_checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

constexpr double kLeastSeconds = 1e-9;
constexpr double kMostSeconds = 1e6;

}  // namespace

void requireTexts(const JsonFields& fields, std::initializer_list<const char*> keys) {
  for (const char* key : keys) fields.text(key);
}

void requireFigures(const JsonFields& fields, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (!fields.get(key).is_null()) fields.number(key);
}

void requireCounts(const JsonFields& fields, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (!fields.get(key).is_number_unsigned()) throw InputError(fields.where(key) + " is not a count");
}

void requireSome(const JsonFields& fields, std::initializer_list<const char*> keys) {
  requireCounts(fields, keys);
  for (const char* key : keys)
    if (fields.get(key).get<std::uint64_t>() == 0) throw InputError(fields.where(key) + " is 0");
}

void requireSeconds(const JsonFields& fields, const char* key) {
  const double value = fields.number(key);
  if (value < kLeastSeconds || value > kMostSeconds)
    throw InputError(fmt::format("{} is {:g}, not a time within {:g}..{:g} s", fields.where(key), value,
                                 kLeastSeconds, kMostSeconds));
}

void requireOrder(const JsonFields& fields, const char* less, const char* more) {
  if (fields.get(less).is_null() || fields.get(more).is_null()) return;
  if (fields.number(less) > fields.number(more))
    throw InputError(fmt::format("{} is above {}", fields.where(less), more));
}

void requireTruths(const JsonFields& fields, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (!fields.get(key).is_boolean()) throw InputError(fields.where(key) + " is neither true nor false");
}

void requireNonEmpty(const JsonFields& fields, const char* key) {
  if (fields.array(key).empty()) throw InputError(fields.where(key) + " is empty");
}

void forEach(const JsonFields& fields, const char* key, const std::function<void(const JsonFields&)>& check) {
  const Json& array = fields.array(key);
  for (std::size_t i = 0; i < array.size(); ++i)
    check(JsonFields(array[i], fmt::format("{}[{}]", fields.where(key), i)));
}

void requireCountsByName(const JsonFields& fields, const char* key) {
  const JsonFields inner(fields.get(key), fields.where(key));
  for (const auto& [name, value] : fields.get(key).items()) requireCounts(inner, {name.c_str()});
}

void requireFormat(const JsonFields& file, const char* format) {
  if (!file.has("format") || !file.get("format").is_string() || file.text("format") != format)
    throw InputError(fmt::format("not what is asked for: format is not \"{}\"", format));
  if (!file.get("version").is_number_integer() || file.get("version").get<std::int64_t>() != 1)
    throw InputError("version is not 1, the only one known");
  requireTexts(file, {"command", "tool_version"});
}

void requireOneOf(const JsonFields& fields, const char* key, std::initializer_list<std::string_view> names) {
  const std::string text = fields.text(key);
  if (std::find(names.begin(), names.end(), text) == names.end())
    throw InputError(fmt::format("{} is not one of {}", fields.where(key), fmt::join(names, ", ")));
}

void requireOptions(const JsonFields& fields, const char* key) {
  const JsonFields options(fields.get(key), fields.where(key));
  for (const auto& [name, value] : fields.get(key).items())
    if (!value.is_primitive()) throw InputError(options.where(name.c_str()) + " is neither number nor text");
}

Json checkedJson(std::string_view text, const std::string& name,
                 const std::function<void(const JsonFields&)>& check) {
  Json out;
  readJson(text, name, [&](const Json& json) {
    check(JsonFields(json, ""));
    out = json;
  });
  return out;
}

}  // namespace ltcfit
