#include "export/texture_metadata.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "export/atomic_file.h"
#include "export/c_text.h"
#include "export/json_fields.h"

namespace ltcfit {
namespace {

constexpr const char* kTextureFormat = "ltc-texture";
constexpr int kTextureVersion = 1;
// A table has 11 channels at most.
constexpr std::size_t kMaxTextures = 16;
constexpr std::string_view kLineStart = "ltcfit-metadata:";

Json coordinates(const TableInfo& info) {
  const std::vector<Axis>& axes = info.axes;
  if (axes.size() == 2) {
    return {{"x", axisFormula(axes[1])},
            {"y", axisFormula(axes[0])},
            {"uv", "coordinate * (size - 1) / size + 0.5 / size"},
            {"frame", "z = normal, view vector in the x-z plane with x >= 0: the lobe leans to -x"}};
  }
  return {{"x", axisFormula(axes[3])},
          {"y", axisFormula(axes[2])},
          {"z", fmt::format("slice lambda + {} alpha, lambda = {} and alpha = {} in units of their nodes",
                            axes[1].size(), axisFormula(axes[1]), axisFormula(axes[0]))},
          {"uv", "coordinate * (size - 1) / size + 0.5 / size"},
          {"frame",
           "tangent frame, z = normal; theta, phi of the view; alpha = max(alpha_x, alpha_y), lambda = min / "
           "max; "
           "other quadrants by F M F, alpha_y > alpha_x by P M P"}};
}

PackedTable read(const Json& json) {
  const JsonFields file(json, "");
  if (file.text("format") != kTextureFormat)
    throw InputError("format is not \"" + std::string(kTextureFormat) + "\"");
  if (!file.get("version").is_number_integer() || file.get("version") != kTextureVersion)
    throw InputError(fmt::format("version is not known; this program reads version {}", kTextureVersion));
  PackedTable packed;
  packed.info.brdf = file.text("brdf");
  if (packed.info.brdf != "ggx") throw InputError("brdf '" + packed.info.brdf + "' is not known (ggx)");
  for (const Json& axis : file.array("axes"))
    packed.info.axes.push_back(axisFromJson(axis, fmt::format("axes[{}]", packed.info.axes.size())));
  const JsonFields matrix(file.get("matrix"), "matrix");
  packed.info.stores = matrixStorageFromName(matrix.text("stores"));
  packed.info.normalization = matrixNormalizationFromName(matrix.text("normalization"));
  packed.packing.stores = packed.info.stores;
  packed.packing.divisor = divisorFromName(matrix.text("divided_by"));
  packed.scale = matrix.number("scale");
  int exponent = 0;
  if (!(packed.scale > 0.0) || packed.scale > 65536.0 || std::frexp(packed.scale, &exponent) != 0.5)
    throw InputError("matrix.scale is not a power of two up to 65536");
  if (packed.info.normalization != normalizationOf(packed.packing.divisor))
    throw InputError("matrix.normalization and matrix.divided_by contradict each other");
  const std::string precision = file.text("precision");
  if (precision != "float32" && precision != "float16")
    throw InputError("precision '" + precision + "' is not known (float32, float16)");
  packed.precision = precision == "float16" ? Precision::kHalf : Precision::kFloat;
  for (const Json& texture : file.array("textures")) {
    const JsonFields fields(texture, fmt::format("textures[{}]", packed.packing.textures.size()));
    packed.packing.textures.push_back({fields.text("name"), fields.texts("components")});
  }
  if (packed.packing.textures.size() > kMaxTextures)
    throw InputError(fmt::format("textures: more than {}", kMaxTextures));
  if (file.has("files")) {
    for (const Json& entry : file.array("files")) {
      const JsonFields fields(entry, fmt::format("files[{}]", packed.files.size()));
      const std::string name = fields.text("name");
      if (name.empty() || name.find_first_of("/\\") != std::string::npos ||
          name.find('\0') != std::string::npos)
        throw InputError("files: '" + name + "' is not the name of a file in the same folder");
      packed.files.emplace_back(name, fields.text("checksum"));
      if (packed.files.size() > kMaxTextures) throw InputError("files: more than a table has");
    }
  }
  if (file.has("container")) packed.container = file.text("container");
  readOrigin(file, packed.info);
  return packed;
}

Json metadataJson(const PackedTable& packed, const std::string& container) {
  const TableInfo& info = packed.info;
  Json json{{"format", kTextureFormat}, {"version", kTextureVersion}, {"brdf", info.brdf}};
  json["brdf_definition"] =
      "GGX, height-correlated Smith masking-shadowing, F = 1, times cos(theta_light); alpha = roughness^2";
  for (const Axis& axis : info.axes) json["axes"].push_back(axisToJson(axis));
  json["matrix"] = {{"stores", matrixStorageName(info.stores)},
                    {"normalization", matrixNormalizationName(info.normalization)},
                    {"divided_by", divisorName(packed.packing.divisor)},
                    {"scale", packed.scale},
                    {"index_order", "m{row}{column}; the matrix times a column vector"}};
  json["precision"] = packed.precision == Precision::kHalf ? "float16" : "float32";
  for (const TextureSpec& texture : packed.packing.textures)
    json["textures"].push_back({{"name", texture.name}, {"components", texture.components}});
  if (!packed.images.empty()) {
    const Image& image = packed.images[0];
    json["texture_size"] = {image.width, image.height, image.depth};
  }
  for (const auto& [name, sum] : packed.files) json["files"].push_back({{"name", name}, {"checksum", sum}});
  json["container"] = container;
  json["coordinates"] = coordinates(info);
  json["channels"] = {{"norm", "directional albedo n_D"},
                      {"fresnel", "Schlick-weighted albedo f_D; specular = F0 norm + (F90 - F0) fresnel"},
                      {"sphere",
                       "horizon-clipped form factor of a sphere over its length; x = (cos + 1) / 2, y = "
                       "length of the vector form factor"}};
  json["alpha_floor"] = info.alphaFloor;
  json["provenance"] = provenanceToJson(info.provenance);
  if (packed.precision == Precision::kHalf) {
    const HalfReport& half = packed.half;
    json["rounding"] = {
        {"rule",
         "per node the halves whose lobe is closest; diagonals normal, signs kept, determinants within 1 %"},
        {"nodes_not_nearest", half.moved},
        {"nodes_bounded", half.constrained},
        {"determinants_hold_from_alpha",
         std::isfinite(half.alphaFloor) ? Json(half.alphaFloor) : Json("none")},
        {"nodes_below_that", half.beyond},
        {"largest_lobe_shift_rad", half.largestShift},
        {"largest_determinant_error", half.largestDetError}};
  }
  return json;
}

}  // namespace

std::string sidecarPath(const std::string& path) {
  return path + ".json";
}

std::string textureMetadata(const PackedTable& packed, const std::string& container) {
  return metadataJson(packed, container).dump(1) + "\n";
}

std::string metadataLine(const PackedTable& packed, const std::string& container) {
  std::string line(kLineStart);
  line += ' ';
  // JSON may write a slash as "\/", and no comment begins or ends with that
  for (char c : metadataJson(packed, container).dump(-1, ' ', true))
    line += c == '/' ? std::string("\\/") : std::string(1, c);
  return line;
}

std::optional<std::string> metadataOfSource(std::string_view text) {
  const std::size_t at = text.rfind(kLineStart);
  if (at == std::string_view::npos) return std::nullopt;
  // a formatter may have broken the comment at blanks: line ends and what begins a line of a comment are one
  // blank
  std::string line;
  const std::string_view rest = text.substr(at + kLineStart.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (rest[i] != '\n') {
      line += rest[i];
      continue;
    }
    i = std::min(rest.find_first_not_of(" \t\r\n", i), rest.size());
    if (rest.substr(i, 2) == "//") i += 2;
    if (rest.substr(i, 1) == "*" && rest.substr(i, 2) != "*/") ++i;
    i = std::min(rest.find_first_not_of(" \t\r\n", i), rest.size()) - 1;
    while (line.ends_with(' ') || line.ends_with('\r')) line.pop_back();
    line += ' ';
  }
  // a slash within the JSON has a backslash before it
  const std::size_t end = std::min(line.find("*/"), line.size());
  const std::size_t open = std::min(line.find_first_not_of(' '), end);
  const std::size_t brace = std::string_view(line).substr(0, end).rfind('}');
  return brace == std::string::npos || brace < open ? std::string() : line.substr(open, brace + 1 - open);
}

std::string matrixText(const PackedTable& packed) {
  std::string divisor;
  if (packed.packing.divisor == Divisor::kThirdColumn) {
    divisor = ", divided by the length of its third column";
  } else if (packed.packing.divisor != Divisor::kNone) {
    divisor = fmt::format(", divided by {}", divisorName(packed.packing.divisor));
  }
  return fmt::format("{}{}{}, m{{row}}{{column}}, times column vectors",
                     packed.info.stores == MatrixStorage::kM ? "M" : "Minv, the inverse of M", divisor,
                     packed.scale == 1.0 ? "" : fmt::format(", times {}", packed.scale));
}

std::vector<std::string> describeTextures(const PackedTable& packed) {
  const TableInfo& info = packed.info;
  const bool isotropic = info.axes.size() == 2;
  std::vector<std::string> lines{
      fmt::format("Linearly Transformed Cosines for {} GGX (height-correlated Smith, F = 1).",
                  isotropic ? "isotropic" : "anisotropic"),
      originText(info.provenance), ""};
  lines.push_back(fmt::format("Matrix: {}; {}.", matrixText(packed),
                              info.stores == MatrixStorage::kM
                                  ? "invert it after interpolation"
                                  : "it takes light vectors to the clamped cosine"));
  for (std::size_t t = 0; t < packed.packing.textures.size(); ++t) {
    const TextureSpec& texture = packed.packing.textures[t];
    lines.push_back(fmt::format("{}: ({})", texture.name, fmt::join(texture.components, ", ")));
  }
  lines.push_back(
      "norm: directional albedo; fresnel: Schlick-weighted. specular = F0 norm + (F90 - F0) fresnel.");
  const Json places = coordinates(info);
  for (const auto& [key, value] : places.items())
    lines.push_back(fmt::format("{}: {}", key, value.get<std::string>()));
  lines.push_back(fmt::format("Precision: {}. alpha_x and alpha_y were fitted no smaller than {:.9g}. Nodes:",
                              packed.precision == Precision::kHalf ? "half" : "float32", info.alphaFloor));
  for (const Axis& axis : info.axes) {
    std::string line = axis.name + ":";
    for (double v : axis.values) {
      if (line.size() > 100) {
        lines.push_back(line);
        line.assign(1, ' ');
      }
      line += fmt::format(" {:.9g}", v);
    }
    lines.push_back(line);
  }
  for (std::string& line : lines) line = commentSafe(line);
  return lines;
}

bool isTextureMetadata(std::string_view text) {
  if (text.find(kTextureFormat) == std::string_view::npos) return false;
  bool is = false;
  try {
    readJson(text, "", [&](const Json& json) {
      is = json.is_object() && json.contains("format") && json["format"] == kTextureFormat;
    });
  } catch (const InputError&) {
    is = true;  // damaged, which the reader will say
  }
  return is;
}

PackedTable packedFromMetadata(std::string_view text, const std::string& name) {
  PackedTable packed;
  readJson(text, name, [&](const Json& json) { packed = read(json); });
  return packed;
}

}  // namespace ltcfit
