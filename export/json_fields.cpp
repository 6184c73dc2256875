#include "export/json_fields.h"

#include <fmt/format.h>

#include "base/refusal.h"
#include "export/atomic_file.h"

namespace ltcfit {
namespace {

// Members of one object: some five times what any of our files has. The parser keeps them in order and looks
// for a doubled one among all that came before, so that without a limit 10 MB of members take minutes.
constexpr std::size_t kMaxMembers = 256;

Json parseLimited(std::string_view text) {
  // the parser takes a zero for the end
  if (text.find('\0') != std::string_view::npos) throw InputError("a zero byte, which no JSON has");
  std::vector<std::size_t> members;  // of each open object
  return Json::parse(text, [&](int, Json::parse_event_t event, const Json&) {
    if (event == Json::parse_event_t::object_start) members.push_back(0);
    if (event == Json::parse_event_t::object_end) members.pop_back();
    if (event == Json::parse_event_t::key && ++members.back() > kMaxMembers)
      throw InputError(fmt::format("an object has more than {} members", kMaxMembers));
    return true;
  });
}

Provenance provenanceFromJson(const Json& json) {
  const JsonFields reader(json, "provenance");
  Provenance p;
  if (reader.has("tool")) p.tool = reader.text("tool");
  if (reader.has("tool_version")) p.toolVersion = reader.text("tool_version");
  if (reader.has("command")) p.command = reader.text("command");
  if (reader.has("seed")) {
    if (!reader.get("seed").is_number_integer()) throw InputError("provenance.seed is not an integer");
    p.seed = reader.get("seed").get<std::int64_t>();
  }
  if (!reader.has("options")) return p;
  const JsonFields options(reader.get("options"), "provenance.options");
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

}  // namespace

JsonFields::JsonFields(const Json& json, std::string path) : json_(json), path_(std::move(path)) {
  if (!json_.is_object()) fail("is not an object");
}

void JsonFields::fail(const std::string& what) const {
  throw InputError((path_.empty() ? std::string("the file") : path_) + " " + what);
}

const Json& JsonFields::get(const char* key) const {
  if (!has(key)) throw InputError(where(key) + " is missing");
  return json_[key];
}

std::string JsonFields::text(const char* key) const {
  const Json& v = get(key);
  if (!v.is_string()) throw InputError(where(key) + " is not a string");
  return v.get<std::string>();
}

double JsonFields::number(const char* key) const {
  const Json& v = get(key);
  if (!v.is_number()) throw InputError(where(key) + " is not a number");
  return v.get<double>();
}

const Json& JsonFields::array(const char* key) const {
  const Json& v = get(key);
  if (!v.is_array()) throw InputError(where(key) + " is not an array");
  return v;
}

std::vector<double> JsonFields::numbers(const char* key) const {
  const Json& v = array(key);
  std::vector<double> out;
  out.reserve(v.size());
  for (const Json& x : v) {
    if (!x.is_number()) throw InputError(fmt::format("{}[{}] is not a number", where(key), out.size()));
    out.push_back(x.get<double>());
  }
  return out;
}

std::vector<std::string> JsonFields::texts(const char* key) const {
  std::vector<std::string> out;
  for (const Json& x : array(key)) {
    if (!x.is_string()) throw InputError(fmt::format("{}[{}] is not a string", where(key), out.size()));
    out.push_back(x.get<std::string>());
  }
  return out;
}

Json axisToJson(const Axis& axis) {
  Json json{{"name", axis.name}, {"unit", axis.unit}};
  if (axis.map != AxisMap::kNone) {
    json["map"] = axisMapName(axis.map);
    json["range"] = {axis.low, axis.high};
    if (axis.warp != AxisWarp{}) json["warp"] = axis.warp;
  }
  json["values"] = axis.values;
  return json;
}

Axis axisFromJson(const Json& json, const std::string& path) {
  const JsonFields reader(json, path);
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
  if (reader.has("warp")) {
    const std::vector<double> warp = reader.numbers("warp");
    if (warp.size() != 2) throw InputError(reader.where("warp") + " needs two numbers");
    axis.warp = {warp[0], warp[1]};
  }
  return axis;
}

void readOrigin(const JsonFields& file, TableInfo& info) {
  if (file.has("alpha_floor")) info.alphaFloor = file.number("alpha_floor");
  if (file.has("provenance")) info.provenance = provenanceFromJson(file.get("provenance"));
}

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

void readJson(std::string_view text, const std::string& name, const std::function<void(const Json&)>& read) {
  try {
    read(parseLimited(text));
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  } catch (const Json::parse_error& error) {
    throw InputError(fmt::format("{}: not valid JSON at byte {} of {} (truncated or damaged?)", name,
                                 error.byte, text.size()));
  } catch (const Json::exception& error) {
    throw InputError(name + ": " + error.what());
  } catch (const Refusal& error) {
    throw InputError(name + ": " + error.what());
  }
}

}  // namespace ltcfit
