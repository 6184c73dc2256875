#include "tailor/plan_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/angles.h"
#include "export/atomic_file.h"
#include "export/figure.h"
#include "export/json_fields.h"

namespace ltcfit {
namespace {

constexpr const char* kPlanFormat = "ltc-plan";
constexpr int kPlanVersion = 1;
constexpr std::size_t kMostLobesRead = 65536;

Json requestToJson(const PlanRequest& r) {
  return {{"max_error", r.maxError},     {"no_stricter_than_full", r.noStricterThanFull},
          {"max_bytes", r.maxBytes},     {"margin", r.margin},
          {"alpha_floor", r.alphaFloor}, {"seed", r.seed}};
}

Json costToJson(const TableCost& cost) {
  return {{"nodes", cost.nodes},
          {"bytes", cost.bytes},
          {"textures", cost.textures},
          {"fetches", cost.fetches},
          {"predicted_error", figure(cost.error)}};
}

Json tableToJson(const PlannedTable& t) {
  Json json{{"kind", t.distribution.isotropic ? "isotropic" : "anisotropic"},
            {"reasons", t.reasons},
            {"channels", t.amplitudes},
            {"precision", "half"},
            {"max_error", t.maxError},
            {"max_bytes", t.maxBytes},
            {"expected", costToJson(t.cost)},
            {"within_max_error", t.reachable},
            {"full_table", costToJson(t.full)}};
  for (const Axis& axis : t.axes) json["axes"].push_back(axisToJson(axis));
  for (const auto& [bytes, error] : t.curve) json["bytes_and_error"].push_back({bytes, figure(error)});
  Json lobes = Json::array();
  for (const LobeUse& l : t.distribution.lobes) lobes.push_back({l.alphaX, l.alphaY, l.f0, l.f90, l.weight});
  json["distribution"] = {{"views", {t.distribution.views.low, t.distribution.views.high}},
                          {"lobes", std::move(lobes)}};
  return json;
}

Json materialToJson(const MaterialSummary& m) {
  Json json{{"name", m.name}, {"area", figure(m.area)}};
  if (m.texels > 0) json["texels"] = m.texels;
  json["roughness"] = {figure(m.roughness[0]), figure(m.roughness[1]), figure(m.roughness[2])};
  json["lambda"] = {figure(m.lambda[0]), figure(m.lambda[1])};
  json["f0"] = {figure(m.f0[0]), figure(m.f0[1])};
  json["reasons"] = m.reasons;
  return json;
}

Json lightsToJson(const LightUse& l) {
  return {{"polygon", l.polygon},   {"disk", l.disk},          {"sphere", l.sphere},
          {"textured", l.textured}, {"one_sided", l.oneSided}, {"two_sided", l.twoSided},
          {"reasons", l.reasons}};
}

bool flag(const JsonFields& fields, const char* key) {
  const Json& value = fields.get(key);
  if (!value.is_boolean()) throw InputError(fields.where(key) + " is not true or false");
  return value.get<bool>();
}

std::size_t readBytes(const JsonFields& fields) {
  const double bytes = fields.number("max_bytes");
  if (!(bytes >= 0.0 && bytes <= 1e12)) throw InputError(fields.where("max_bytes") + ": need 0 to 1e12");
  return static_cast<std::size_t>(bytes);
}

PlanRequest readRequest(const JsonFields& fields) {
  PlanRequest r;
  r.maxError = fields.number("max_error");
  r.noStricterThanFull = flag(fields, "no_stricter_than_full");
  r.maxBytes = readBytes(fields);
  r.margin = fields.number("margin");
  r.alphaFloor = fields.number("alpha_floor");
  const double seed = fields.number("seed");
  if (!(seed >= 0.0 && seed <= 9e15)) throw InputError(fields.where("seed") + ": need 0 to 9e15");
  r.seed = static_cast<std::int64_t>(seed);
  std::string error;
  if (!r.isValid(&error)) throw InputError("request: " + error);
  return r;
}

LobeUse readLobe(const Json& json, const std::string& where, bool isotropic) {
  const auto fail = [&where](const std::string& what) { throw InputError(where + ": " + what); };
  if (!json.is_array() || json.size() != 5) fail("need [alpha_x, alpha_y, f0, f90, weight]");
  std::array<double, 5> v{};
  for (std::size_t i = 0; i < 5; ++i) {
    if (!json[i].is_number()) fail("need five numbers");
    v[i] = json[i].get<double>();
    if (!std::isfinite(v[i]) || v[i] < 0.0) fail("need finite numbers, none negative");
  }
  for (std::size_t i = 0; i < 4; ++i)
    if (v[i] > 1.0) fail("alphas, f0 and f90 are 1 at most");
  if (v[1] > v[0]) fail("alpha_y is greater than alpha_x, which is the larger one");
  if (isotropic != (v[0] == v[1]))
    fail(isotropic ? "an isotropic table needs equal alphas" : "equal alphas belong to the isotropic table");
  if (v[4] == 0.0) fail("a weight is 0");
  if (v[2] == 0.0 && v[3] == 0.0) fail("f0 and f90 are both 0: this lobe is not there");
  return {v[0], v[1], v[2], v[3], v[4]};
}

LobeDistribution readDistribution(const JsonFields& table, const std::string& where) {
  LobeDistribution d;
  const std::string kind = table.text("kind");
  if (kind != "isotropic" && kind != "anisotropic")
    throw InputError(fmt::format("{}.kind '{}' (isotropic or anisotropic)", where, kind));
  d.isotropic = kind == "isotropic";
  const std::string inner = where + ".distribution";
  const JsonFields fields(table.get("distribution"), inner);
  const std::vector<double> views = fields.numbers("views");
  if (views.size() != 2 || !(views[0] >= 0.0 && views[0] <= views[1] && views[1] <= kHalfPi + 1e-6))
    throw InputError(inner + ".views: need two angles in radians, increasing, from 0 to pi/2");
  d.views = {views[0], std::min(views[1], kHalfPi)};
  const Json& lobes = fields.array("lobes");
  if (lobes.empty() || lobes.size() > kMostLobesRead)
    throw InputError(fmt::format("{}.lobes: {} lobes, need 1 to {}", inner, lobes.size(), kMostLobesRead));
  for (std::size_t i = 0; i < lobes.size(); ++i)
    d.lobes.push_back(readLobe(lobes[i], fmt::format("{}.lobes[{}]", inner, i), d.isotropic));
  return d;
}

ScenePlan readPlan(const Json& json) {
  const JsonFields file(json, "");
  if (file.text("format") != kPlanFormat) throw InputError(fmt::format("format is not \"{}\"", kPlanFormat));
  const Json& version = file.get("version");
  if (!version.is_number_integer() || version != kPlanVersion)
    throw InputError(fmt::format("version {} is not known; this program reads version {}",
                                 version.is_number() ? version.dump() : std::string("of another type"),
                                 kPlanVersion));
  ScenePlan plan;
  plan.scene = file.text("scene");
  plan.request = readRequest(JsonFields(file.get("request"), "request"));
  const JsonFields lights(file.get("lights"), "lights");
  plan.lights = {flag(lights, "polygon"),
                 flag(lights, "disk"),
                 flag(lights, "sphere"),
                 flag(lights, "textured"),
                 flag(lights, "one_sided"),
                 flag(lights, "two_sided"),
                 {}};
  const Json& tables = file.array("tables");
  if (tables.size() > 2) throw InputError("tables: more than two");
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::string where = fmt::format("tables[{}]", i);
    PlannedTable table;
    const JsonFields fields(tables[i], where);
    table.distribution = readDistribution(fields, where);
    table.maxError = fields.number("max_error");
    if (table.maxError != 0.0 && !(table.maxError >= 1e-5 && table.maxError <= 1.0))
      throw InputError(fields.where("max_error") + ": need 1e-5 to 1, or 0");
    table.maxBytes = readBytes(fields);
    if (table.maxError == 0.0 && table.maxBytes == 0)
      throw InputError(where + ": needs max_error or max_bytes");
    plan.tables.push_back(std::move(table));
  }
  if (plan.tables.size() == 2 &&
      plan.tables[0].distribution.isotropic == plan.tables[1].distribution.isotropic)
    throw InputError("tables: two of one kind");
  return plan;
}

}  // namespace

std::string planToJson(const ScenePlan& plan) {
  Json json{
      {"format", kPlanFormat},
      {"version", kPlanVersion},
      {"about",
       "ltcfit fit --plan reads scene, request, lights and of each table kind, max_error, max_bytes and "
       "distribution; all else says what is expected and why"},
      {"scene", plan.scene},
      {"request", requestToJson(plan.request)},
      {"lights", lightsToJson(plan.lights)},
      {"shading", plan.shading},
      {"notes", plan.notes},
      {"materials", Json::array()},
      {"tables", Json::array()}};
  for (const MaterialSummary& m : plan.materials) json["materials"].push_back(materialToJson(m));
  for (const PlannedTable& t : plan.tables) json["tables"].push_back(tableToJson(t));
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

ScenePlan planFromJson(std::string_view text, const std::string& name) {
  // a value of the parser's tree with its key, and twice that while an array grows
  constexpr std::size_t kBytesPerValue = 128;
  const auto values = static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return c == ',' || c == '[' || c == '{'; }));
  const std::size_t memory = values * kBytesPerValue + text.size();
  if (text.size() > kMaxPlanBytes || memory > kMaxPlanMemory)
    throw InputError(
        fmt::format("{}: {} bytes of JSON, which would take some {} bytes of memory; up to {} and {} "
                    "are read: plan parts of the scene one by one",
                    name, text.size(), memory, kMaxPlanBytes, kMaxPlanMemory));
  ScenePlan plan;
  readJson(text, name, [&plan](const Json& json) { plan = readPlan(json); });
  return plan;
}

}  // namespace ltcfit
