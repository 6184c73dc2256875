// Pieces of the JSON files: fields with messages that name them, axes, provenance.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "ltc/table.h"

namespace ltcfit {

using Json = nlohmann::ordered_json;

/// Access to an object's fields. Every function throws InputError naming the field when it is missing or of
/// another type.
class JsonFields {
 public:
  /// `path` names the object in messages; empty for the file itself. `json` must outlive this.
  JsonFields(const Json& json, std::string path);

  [[noreturn]] void fail(const std::string& what) const;
  bool has(const char* key) const { return json_.contains(key); }
  const Json& get(const char* key) const;
  std::string text(const char* key) const;
  double number(const char* key) const;
  const Json& array(const char* key) const;
  std::vector<double> numbers(const char* key) const;
  std::vector<std::string> texts(const char* key) const;
  std::string where(const char* key) const { return path_.empty() ? std::string(key) : path_ + "." + key; }

 private:
  const Json& json_;
  std::string path_;
};

Json axisToJson(const Axis& axis);
Axis axisFromJson(const Json& json, const std::string& path);

/// The fields alpha_floor and provenance, where the object has them.
void readOrigin(const JsonFields& file, TableInfo& info);
Json provenanceToJson(const Provenance& provenance);

/// Parses `text` and calls `read`; every failure of either becomes an InputError that starts with `name`.
void readJson(std::string_view text, const std::string& name, const std::function<void(const Json&)>& read);

}  // namespace ltcfit
