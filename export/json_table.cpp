#include "export/json_table.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "export/atomic_file.h"
#include "export/json_fields.h"

namespace ltcfit {
namespace {

constexpr const char* kTableFormat = "ltc-table";
constexpr int kTableVersion = 1;

Table readTable(const Json& json) {
  const JsonFields file(json, "");
  if (file.text("format") != kTableFormat)
    throw InputError("format is not \"" + std::string(kTableFormat) + "\"");
  const Json& version = file.get("version");
  if (!version.is_number_integer() || version != kTableVersion) {
    throw InputError(fmt::format("version {} is not known; this program reads version {}",
                                 version.is_number() ? version.dump() : std::string("of another type"),
                                 kTableVersion));
  }
  TableInfo info;
  info.brdf = file.text("brdf");
  if (info.brdf != "ggx") throw InputError("brdf '" + info.brdf + "' is not known (ggx)");
  for (const Json& axis : file.array("axes")) {
    info.axes.push_back(axisFromJson(axis, fmt::format("axes[{}]", info.axes.size())));
  }
  const JsonFields matrix(file.get("matrix"), "matrix");
  info.stores = matrixStorageFromName(matrix.text("stores"));
  info.normalization = matrixNormalizationFromName(matrix.text("normalization"));
  info.channels = file.texts("channels");
  readOrigin(file, info);
  const std::vector<double> numbers = file.numbers("data");
  std::vector<float> data(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::abs(numbers[i]) > static_cast<double>(std::numeric_limits<float>::max())) {
      throw InputError(
          fmt::format("data[{}] = {} ({}) does not fit a float32", i, numbers[i], numberName(info, i)));
    }
    data[i] = static_cast<float>(numbers[i]);
  }
  return Table(std::move(info), std::move(data));
}

}  // namespace

std::string tableToJson(const Table& table) {
  const TableInfo& info = table.info();
  std::string out = "{\n";
  const auto field = [&out](const char* key, const Json& value) {
    out += fmt::format("  \"{}\": {},\n", key, value.dump());
  };
  field("format", kTableFormat);
  field("version", kTableVersion);
  field("brdf", info.brdf);
  out += "  \"axes\": [";
  for (std::size_t a = 0; a < info.axes.size(); ++a) {
    out += (a == 0 ? "\n    " : ",\n    ") + axisToJson(info.axes[a]).dump();
  }
  out += "\n  ],\n";
  field("matrix", {{"stores", matrixStorageName(info.stores)},
                   {"normalization", matrixNormalizationName(info.normalization)}});
  field("channels", info.channels);
  field("alpha_floor", info.alphaFloor);
  field("provenance", provenanceToJson(info.provenance));
  out += "  \"data\": [";
  const std::size_t channels = table.channelCount();
  for (std::size_t i = 0; i < table.data().size(); ++i) {
    out += i == 0 ? "\n    " : (i % channels == 0 ? ",\n    " : ", ");
    fmt::format_to(std::back_inserter(out), "{}", table.data()[i]);  // shortest that reads back
  }
  return out + "\n  ]\n}\n";
}

Table tableFromJson(std::string_view text, const std::string& name) {
  std::optional<Table> table;
  readJson(text, name, [&](const Json& json) { table.emplace(readTable(json)); });
  return std::move(*table);
}

void checkJson(std::string_view text, const std::string& name) {
  readJson(text, name, [](const Json&) {});
}

}  // namespace ltcfit
