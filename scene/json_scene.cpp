#include "scene/json_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <numeric>

#include "export/atomic_file.h"
#include "export/json_fields.h"
#include "scene/gltf_uri.h"
#include "scene/json_text.h"
#include "scene/lobe_histogram.h"
#include "scene/texel_image.h"

namespace ltcfit {
namespace {

constexpr std::size_t kMaxCombinations = std::size_t{1} << 22;
constexpr std::size_t kRangeValues = 65;
// Some ten thousand materials; the parser's time grows with their square.
constexpr std::size_t kMaxDescription = std::size_t{1} << 20;

void rejectUnknown(const Json& object, const std::string& where, std::initializer_list<const char*> known) {
  for (const auto& [key, value] : object.items())
    if (std::none_of(known.begin(), known.end(), [&, &name = key](const char* k) { return name == k; }))
      throw InputError(
          fmt::format("{} has the unknown field '{}'; there is {}", where, key, fmt::join(known, ", ")));
}

struct Distribution {
  std::vector<double> values;
  std::vector<double> weights;
  std::size_t texels = 0;
  std::string reason;
};

double inRange(const Json& value, const std::string& where, double low, double high) {
  if (!value.is_number()) throw InputError(where + " is not a number");
  const double number = value.get<double>();
  if (!(number >= low && number <= high))
    throw InputError(fmt::format("{} is {}, not within {} to {}", where, number, low, high));
  return number;
}

// Reads distributions of one file, whose images share one limit.
class Distributions {
 public:
  explicit Distributions(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// `rooted`: a range is even in the root.
  Distribution read(const Json& json, const std::string& where, bool rooted) {
    Distribution out;
    if (json.is_number()) {
      out.values = {inRange(json, where, 0.0, 1.0)};
      out.weights = {1.0};
      out.reason = fmt::format("{} is {}.", where, out.values[0]);
      return out;
    }
    if (json.is_array()) return range(json, where, rooted);
    if (!json.is_object())
      throw InputError(where + " is neither a number, a range [low, high], values nor an image");
    return json.contains("image") ? image(json, where) : some(json, where);
  }

 private:
  static Distribution range(const Json& json, const std::string& where, bool rooted) {
    if (json.size() != 2) throw InputError(where + " is not a range [low, high]");
    const double low = inRange(json[0], where + "[0]", 0.0, 1.0);
    const double high = inRange(json[1], where + "[1]", low, 1.0);
    Distribution out;
    for (std::size_t i = 0; i < kRangeValues; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(kRangeValues - 1);
      const double root = std::lerp(std::sqrt(low), std::sqrt(high), t);
      // the ends exactly
      const double inner = rooted ? root * root : std::lerp(low, high, t);
      out.values.push_back(i == 0 ? low : i + 1 == kRangeValues ? high : inner);
    }
    out.weights.assign(kRangeValues, 1.0);
    out.reason = fmt::format("{} is even over {} to {}.", where, low, high);
    return out;
  }

  static Distribution some(const Json& json, const std::string& where) {
    rejectUnknown(json, where, {"values", "weights"});
    const JsonFields fields(json, where);
    Distribution out;
    for (const Json& value : fields.array("values"))
      out.values.push_back(inRange(value, fmt::format("{}.values[{}]", where, out.values.size()), 0.0, 1.0));
    if (out.values.empty()) throw InputError(where + ".values is empty");
    out.weights.assign(out.values.size(), 1.0);
    out.reason = fmt::format("{} has {} values.", where, out.values.size());
    if (!fields.has("weights")) return out;
    out.weights.clear();
    constexpr double kMostWeight = 1e30;
    for (const Json& value : fields.array("weights"))
      out.weights.push_back(
          inRange(value, fmt::format("{}.weights[{}]", where, out.weights.size()), 0.0, kMostWeight));
    if (out.weights.size() != out.values.size())
      throw InputError(
          fmt::format("{} has {} values and {} weights", where, out.values.size(), out.weights.size()));
    if (std::accumulate(out.weights.begin(), out.weights.end(), 0.0) <= 0.0)
      throw InputError(where + ".weights are all 0");
    return out;
  }

  Distribution image(const Json& json, const std::string& where) {
    rejectUnknown(json, where, {"image", "channel", "scale"});
    const JsonFields fields(json, where);
    const std::string file = fields.text("image");
    const std::string channel = fields.has("channel") ? fields.text("channel") : "r";
    const std::size_t component = std::string_view("rgba").find(channel);
    if (channel.size() != 1 || component == std::string_view::npos)
      throw InputError(fmt::format("{}.channel is '{}'; there is r, g, b, a", where, channel));
    const double scale = fields.has("scale") ? inRange(fields.get("scale"), where + ".scale", 0.0, 1.0) : 1.0;
    const TexelImage picture = decodeTexels(readRelative(folder_, file), file, kMaxTexels - texels_);
    texels_ += picture.texels.size();
    std::array<std::size_t, 256> counts{};
    for (const auto& texel : picture.texels) ++counts[texel[component]];
    Distribution out;
    out.texels = picture.texels.size();
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] == 0) continue;
      out.values.push_back(scale * static_cast<double>(i) / 255.0);
      out.weights.push_back(static_cast<double>(counts[i]));
    }
    out.reason = fmt::format("{} is channel {} of {}, {} x {} texels.", where, channel, file, picture.width,
                             picture.height);
    return out;
  }

  std::filesystem::path folder_;
  std::size_t texels_ = 0;
};

MaterialUse materialOf(const Json& json, const std::string& where, Distributions& distributions,
                       double share) {
  const JsonFields fields(json, where);
  rejectUnknown(json, where, {"name", "roughness", "anisotropy", "alpha_x", "alpha_y", "f0", "f90", "area"});
  MaterialUse out;
  out.name = fields.text("name");
  out.area = share;
  const auto read = [&](const char* key, const char* otherwise, bool rooted = false) {
    return distributions.read(fields.has(key) ? fields.get(key) : Json::parse(otherwise), fields.where(key),
                              rooted);
  };
  const bool alphas = fields.has("alpha_x") || fields.has("alpha_y");
  if (alphas && (fields.has("roughness") || fields.has("anisotropy")))
    throw InputError(where + " has both roughness or anisotropy and alpha_x or alpha_y");
  if (alphas != (fields.has("alpha_x") && fields.has("alpha_y")))
    throw InputError(where + " needs both alpha_x and alpha_y");
  if (!alphas) fields.get("roughness");
  const std::array<Distribution, 4> parts{alphas ? read("alpha_x", "1", true) : read("roughness", "1"),
                                          alphas ? read("alpha_y", "1", true) : read("anisotropy", "0"),
                                          read("f0", "0.04"), read("f90", "1")};
  std::size_t combinations = 1;
  for (const Distribution& part : parts) {
    combinations *= part.values.size();
    if (combinations > kMaxCombinations)
      throw InputError(
          fmt::format("{} has more than {} combinations of its parameters", where, kMaxCombinations));
    out.texels += part.texels;
    out.reasons.push_back(part.reason);
  }
  out.textured = out.texels > 0;
  LobeHistogram lobes;
  const auto& [first, second, f0, f90] = parts;
  for (std::size_t a = 0; a < first.values.size(); ++a)
    for (std::size_t b = 0; b < second.values.size(); ++b)
      for (std::size_t c = 0; c < f0.values.size(); ++c)
        for (std::size_t d = 0; d < f90.values.size(); ++d) {
          LobeUse lobe;
          if (alphas) {
            lobe.alphaX = std::max(first.values[a], second.values[b]);
            lobe.alphaY = std::min(first.values[a], second.values[b]);
          } else {
            lobe.alphaY = first.values[a] * first.values[a];
            lobe.alphaX = lobe.alphaY + (1.0 - lobe.alphaY) * second.values[b] * second.values[b];
          }
          lobe.f0 = f0.values[c];
          lobe.f90 = f90.values[d];
          lobe.weight = first.weights[a] * second.weights[b] * f0.weights[c] * f90.weights[d];
          if (lobe.weight > 0.0) lobes.add(lobe);
        }
  if (lobes.weight() <= 0.0 || !std::isfinite(lobes.weight()))
    throw InputError(where + " has weights whose products are 0 or not finite");
  out.lobes = lobes.lobes(share);
  return out;
}

LightUse lightsOf(const JsonFields& file) {
  LightUse out;
  const auto set = [](const std::string& value, std::initializer_list<std::pair<const char*, bool*>> known,
                      const char* field) {
    std::vector<std::string> names;
    for (const auto& [name, flag] : known) {
      names.emplace_back(name);
      if (value == name) {
        *flag = true;
        return;
      }
    }
    throw InputError(fmt::format("{} has '{}'; there is {}", field, value, fmt::join(names, ", ")));
  };
  if (file.has("lights"))
    for (const std::string& kind : file.texts("lights"))
      set(kind,
          {{"polygon", &out.polygon},
           {"disk", &out.disk},
           {"sphere", &out.sphere},
           {"textured", &out.textured}},
          "lights");
  if (file.has("light_sides"))
    for (const std::string& sides : file.texts("light_sides"))
      set(sides, {{"one", &out.oneSided}, {"two", &out.twoSided}}, "light_sides");
  if (!out.any()) {
    out.reasons.push_back("The description names no lights: say which by --lights.");
  } else {
    if (!out.oneSided && !out.twoSided) out.oneSided = true;
    out.reasons.push_back("The description names them.");
  }
  return out;
}

ViewUse viewsOf(const JsonFields& file) {
  ViewUse out;
  if (!file.has("views")) return out;
  const Json& views = file.array("views");
  if (views.size() != 2) throw InputError("views is not [low, high]");
  const double low = inRange(views[0], "views[0]", 0.0, 90.0);
  const double high = inRange(views[1], "views[1]", low, 90.0);
  out.low = low / 180.0 * std::numbers::pi;
  out.high = high / 180.0 * std::numbers::pi;
  return out;
}

// Shares of the materials' areas.
std::vector<double> sharesOf(const Json& materials, std::vector<std::string>& notes) {
  std::vector<double> areas;
  std::size_t given = 0;
  for (const Json& material : materials) {
    const std::string where = fmt::format("materials[{}]", areas.size());
    const JsonFields fields(material, where);
    constexpr double kMostArea = 1e30;
    const double area =
        fields.has("area") ? inRange(fields.get("area"), where + ".area", 0.0, kMostArea) : 1.0;
    if (area <= 0.0) throw InputError(where + ".area is 0");
    given += fields.has("area") ? 1 : 0;
    areas.push_back(area);
  }
  if (given != 0 && given != areas.size())
    throw InputError(fmt::format("{} of {} materials have an area: all or none must", given, areas.size()));
  if (given == 0 && areas.size() > 1) notes.push_back("No areas are given: all materials count alike.");
  const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
  for (double& area : areas) area /= total;
  return areas;
}

}  // namespace

bool isSceneDescription(std::string_view bytes) {
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  return start != std::string_view::npos && bytes[start] == '{' &&
         bytes.find("\"ltc-scene\"") != std::string_view::npos;
}

SceneUse sceneFromJson(std::string_view bytes, const std::filesystem::path& folder) {
  if (bytes.size() > kMaxDescription)
    throw InputError(
        fmt::format("a description of {} bytes; up to {} are read", bytes.size(), kMaxDescription));
  SceneUse use;
  parseJsonText(bytes);  // for its messages
  readJson(bytes, "description", [&](const Json& json) {
    const JsonFields file(json, "");
    rejectUnknown(json, "the description",
                  {"$schema", "format", "version", "name", "materials", "lights", "light_sides", "views"});
    if (file.has("$schema")) file.text("$schema");  // for editors
    if (file.text("format") != "ltc-scene") throw InputError("format is not 'ltc-scene'");
    if (file.get("version") != Json(1)) throw InputError("version is not 1");
    if (file.has("name")) use.name = file.text("name");
    const Json& materials = file.array("materials");
    if (materials.empty()) throw InputError("materials is empty");
    const std::vector<double> shares = sharesOf(materials, use.notes);
    Distributions distributions(folder);
    for (std::size_t i = 0; i < materials.size(); ++i)
      addMaterial(use, materialOf(materials[i], fmt::format("materials[{}]", i), distributions, shares[i]));
    use.lights = lightsOf(file);
    use.views = viewsOf(file);
  });
  return use;
}

}  // namespace ltcfit
