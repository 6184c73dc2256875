#include "export/json_table.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "ltc-table";
constexpr int kVersion = 1;

Json provenanceToJson(const Provenance& p) {
  Json options = Json::object();
  for (const auto& [key, value] : p.options) {
    std::visit([&, &name = key](const auto& v) { options[name] = v; }, value);
  }
  return {{"tool", p.tool},
          {"tool_version", p.toolVersion},
          {"command", p.command},
          {"seed", p.seed},
          {"options", options}};
}

// Access with messages that name the field.
class Reader {
 public:
  Reader(const Json& json, std::string path) : json_(json), path_(std::move(path)) {
    if (!json_.is_object()) fail("is not an object");
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError((path_.empty() ? std::string("the file") : path_) + " " + what);
  }
  bool has(const char* key) const { return json_.contains(key); }
  const Json& get(const char* key) const {
    if (!has(key)) throw InputError(where(key) + " is missing");
    return json_[key];
  }
  std::string text(const char* key) const {
    const Json& v = get(key);
    if (!v.is_string()) throw InputError(where(key) + " is not a string");
    return v.get<std::string>();
  }
  double number(const char* key) const {
    const Json& v = get(key);
    if (!v.is_number()) throw InputError(where(key) + " is not a number");
    return v.get<double>();
  }
  const Json& array(const char* key) const {
    const Json& v = get(key);
    if (!v.is_array()) throw InputError(where(key) + " is not an array");
    return v;
  }
  std::vector<double> numbers(const char* key) const {
    const Json& v = array(key);
    std::vector<double> out;
    out.reserve(v.size());
    for (const Json& x : v) {
      if (!x.is_number()) throw InputError(fmt::format("{}[{}] is not a number", where(key), out.size()));
      out.push_back(x.get<double>());
    }
    return out;
  }
  std::string where(const char* key) const { return path_.empty() ? std::string(key) : path_ + "." + key; }

 private:
  const Json& json_;
  std::string path_;
};

Axis readAxis(const Json& json, const std::string& path) {
  const Reader reader(json, path);
  Axis axis;
  axis.name = reader.text("name");
  axis.unit = reader.text("unit");
  axis.values = reader.numbers("values");
  if (axis.values.empty()) reader.fail("has no values");
  axis.low = axis.values.front();
  axis.high = axis.values.back();
  if (reader.has("map")) axis.map = axisMapFromName(reader.text("map"));
  if (reader.has("range")) {
    const std::vector<double> range = reader.numbers("range");
    if (range.size() != 2) throw InputError(reader.where("range") + " needs two numbers");
    axis.low = range[0];
    axis.high = range[1];
  }
  return axis;
}

Provenance readProvenance(const Json& json) {
  const Reader reader(json, "provenance");
  Provenance p;
  if (reader.has("tool")) p.tool = reader.text("tool");
  if (reader.has("tool_version")) p.toolVersion = reader.text("tool_version");
  if (reader.has("command")) p.command = reader.text("command");
  if (reader.has("seed")) {
    if (!reader.get("seed").is_number_integer()) throw InputError("provenance.seed is not an integer");
    p.seed = reader.get("seed").get<std::int64_t>();
  }
  if (!reader.has("options")) return p;
  const Reader options(reader.get("options"), "provenance.options");
  for (const auto& [key, value] : reader.get("options").items()) {
    if (value.is_boolean()) {
      p.options.emplace_back(key, value.get<bool>());
    } else if (value.is_number_integer()) {
      p.options.emplace_back(key, value.get<std::int64_t>());
    } else if (value.is_number()) {
      p.options.emplace_back(key, value.get<double>());
    } else if (value.is_string()) {
      p.options.emplace_back(key, value.get<std::string>());
    } else {
      options.fail("'" + key + "' is neither number, string nor boolean");
    }
  }
  return p;
}

Table readTable(const Json& json) {
  const Reader file(json, "");
  if (file.text("format") != kFormat) throw InputError("format is not \"" + std::string(kFormat) + "\"");
  const Json& version = file.get("version");
  if (!version.is_number_integer() || version != kVersion) {
    throw InputError(fmt::format("version {} is not known; this program reads version {}",
                                 version.is_number() ? version.dump() : std::string("of another type"),
                                 kVersion));
  }
  TableInfo info;
  info.brdf = file.text("brdf");
  if (info.brdf != "ggx") throw InputError("brdf '" + info.brdf + "' is not known (ggx)");
  for (const Json& axis : file.array("axes")) {
    info.axes.push_back(readAxis(axis, fmt::format("axes[{}]", info.axes.size())));
  }
  const Reader matrix(file.get("matrix"), "matrix");
  info.stores = matrixStorageFromName(matrix.text("stores"));
  info.normalization = matrixNormalizationFromName(matrix.text("normalization"));
  for (const Json& channel : file.array("channels")) {
    if (!channel.is_string())
      throw InputError(fmt::format("channels[{}] is not a string", info.channels.size()));
    info.channels.push_back(channel.get<std::string>());
  }
  if (file.has("alpha_floor")) info.alphaFloor = file.number("alpha_floor");
  if (file.has("provenance")) info.provenance = readProvenance(file.get("provenance"));
  const std::vector<double> numbers = file.numbers("data");
  std::vector<float> data(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::abs(numbers[i]) > static_cast<double>(std::numeric_limits<float>::max())) {
      throw InputError(fmt::format("data[{}] = {} does not fit a float32", i, numbers[i]));
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
  field("format", kFormat);
  field("version", kVersion);
  field("brdf", info.brdf);
  out += "  \"axes\": [";
  for (std::size_t a = 0; a < info.axes.size(); ++a) {
    const Axis& axis = info.axes[a];
    Json json{{"name", axis.name}, {"unit", axis.unit}};
    if (axis.map != AxisMap::kNone) {
      json["map"] = axisMapName(axis.map);
      json["range"] = {axis.low, axis.high};
    }
    json["values"] = axis.values;
    out += (a == 0 ? "\n    " : ",\n    ") + json.dump();
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
  try {
    return readTable(Json::parse(text));
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  } catch (const Json::parse_error& error) {
    throw InputError(fmt::format("{}: not valid JSON at byte {} of {} (truncated or damaged?)", name,
                                 error.byte, text.size()));
  } catch (const Json::exception& error) {
    throw InputError(name + ": " + error.what());
  } catch (const std::invalid_argument& error) {
    throw InputError(name + ": " + error.what());
  }
}

}  // namespace ltcfit
