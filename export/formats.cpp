#include "export/formats.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>

#include "base/angles.h"
#include "base/refusal.h"
#include "export/anisotropic_c_header.h"
#include "export/c_header.h"
#include "export/chebyshev_file.h"
#include "export/chebyshev_source.h"
#include "export/js_module.h"
#include "export/json_table.h"
#include "export/shader_arrays.h"
#include "export/shader_lookup.h"

namespace ltcfit {
namespace {

// Containers of 2D textures, arrays and volumes hold four numbers a texel; the others any number.
bool isTextureContainer(std::string_view format) {
  return format == "dds" || format == "ktx2";
}

Packing packingFor(const Table& table, std::string_view format, Layout layout) {
  if (layout == Layout::kPacked) return table.isIsotropic() ? packing2017() : packingOfRows();
  if (layout == Layout::kLean) return packingLean(table.info());
  return packingOfChannels(table.info(), isTextureContainer(format) ? 4 : table.channelCount());
}

bool isLookup(const FormatInfo& format) {
  return format.name == "glsl-lookup" || format.name == "hlsl-lookup";
}

// What the shaders that we ship (render/shaders) take for granted about the nodes.
bool isForOurShaders(const Table& table) {
  const std::vector<Axis>& axes = table.info().axes;
  if (table.isIsotropic())
    return axes[0].spans(AxisMap::kSqrtOneMinusCos, kHalfPi) && axes[1].spans(AxisMap::kSqrt, 1.0);
  return axes[0].spans(AxisMap::kLinear, 1.0) && axes[1].spans(AxisMap::kLinear, 1.0) &&
         axes[2].spans(AxisMap::kLinear, kHalfPi) && axes[3].spans(AxisMap::kLinear, kHalfPi);
}

// Depth that every WebGL 2 and OpenGL ES 3 device has for volumes.
constexpr std::size_t kSafeDepth = 256;

void addWarnings(const Table& table, const FormatInfo& format, const FormatOptions& options,
                 ExportResult& result) {
  const bool packed = options.layout != Layout::kChannels && format.name != "json";
  if (packed && !isLookup(format) && !isForOurShaders(table)) {
    result.warnings.push_back(fmt::format(
        "ltc.glsl and ltc.hlsl look up {} from end to end; this table has other axes: --format "
        "glsl-lookup or hlsl-lookup writes its own look-up",
        table.isIsotropic() ? "sqrt(alpha) and sqrt(1 - N.V)" : "alpha, lambda, theta and phi, linearly"));
  }
  const std::size_t depth = 3 * table.info().axes[0].size() * table.info().axes[1].size();
  if (packed && !table.isIsotropic() && depth > kSafeDepth && (format.name == "dds" || format.name == "ktx2"))
    result.warnings.push_back(
        fmt::format("the volume is {} slices deep; WebGL 2 and OpenGL ES 3 promise {}", depth, kSafeDepth));
}

std::string standardPrefix(const Table& table, std::string_view format, const std::string& name) {
  if (format == "h" && !table.isIsotropic()) return "anisomats";
  if (format == "glsl-lookup" || format == "hlsl-lookup") return "ltcScene";
  return std::filesystem::path(name).stem().string();
}

// `name` without the extensions that the files get.
std::string chebyshevName(std::string name) {
  for (const std::string_view extension : {".json", ".cheb"})
    if (name.ends_with(extension)) name.resize(name.size() - extension.size());
  return name;
}

void exportChebyshev(const Table& table, const FormatOptions& options, const std::string& name,
                     ExportResult& result) {
  ChebyshevOptions fit;
  fit.coefficients = options.coefficientBytes / kCoefficientBytes;
  fit.round = roundToHalfPrecision;
  const ChebyshevForm form = fitChebyshev(table, fit);
  const ChebyshevDifference difference = chebyshevDifference(form, table);
  const std::string base = chebyshevName(name);
  const std::string prefix = options.prefix.empty() ? base : options.prefix;
  const auto shader = [&](ShadingLanguage language) {
    return chebyshevToShader(form, difference, prefix, language);
  };
  result.files = {{base + ".cheb.json", chebyshevToJson(form, difference)},
                  {base + ".cheb.glsl", shader(ShadingLanguage::kGlsl)},
                  {base + ".cheb.hlsl", shader(ShadingLanguage::kHlsl)},
                  {base + ".cheb.h", chebyshevToCHeader(form, difference, prefix)},
                  {base + ".cheb.js", chebyshevToModule(form, difference)}};
  result.table = tableOfChebyshev(form);
  result.chebyshev = difference;
}

}  // namespace

std::string_view layoutName(Layout layout) {
  switch (layout) {
    case Layout::kPacked:
      return "packed";
    case Layout::kChannels:
      return "channels";
    case Layout::kLean:
      break;
  }
  return "lean";
}

Layout layoutFromName(std::string_view name) {
  for (Layout layout : {Layout::kPacked, Layout::kChannels, Layout::kLean})
    if (name == layoutName(layout)) return layout;
  throw Refusal(fmt::format("unknown layout '{}' (packed, channels or lean)", name));
}

const std::vector<FormatInfo>& formats() {
  static const std::vector<FormatInfo> list{
      {"h", ".h", "C/C++ header; anisotropic: float anisomats[8][8][8][8][9] and its amplitudes", false,
       false, true},
      {"hlsl", ".hlsl", "HLSL include: static const float4 arrays", false, false, true},
      {"glsl", ".glsl", "GLSL include: const vec4 arrays", false, false, true},
      {"glsl-lookup", ".glsl",
       "GLSL include: the look-up of this table alone, in the textures of --layout lean", false, false, true,
       Layout::kLean},
      {"hlsl-lookup", ".hlsl", "HLSL include: the same", false, false, true, Layout::kLean},
      {"dds", ".dds", "DDS: 2D array of 2 layers, or volume of the 3 rows of M stacked in depth", true, true,
       false},
      {"ktx2", ".ktx2", "KTX2: the same, zstd supercompressed, metadata as key/value", true, true, false},
      {"exr", ".exr", "OpenEXR: a channel for each coefficient; 8^4 laid out 64 x 64", true, true, false,
       Layout::kChannels},
      {"npy", ".npy", "NumPy array, shape as the axes, channels last", true, true, false, Layout::kChannels},
      {"bin", ".bin", "raw little-endian numbers, texture after texture", true, true, false},
      {"js", ".js", "ES module: LTC_MAT_1, LTC_MAT_2 (isotropic) or LTC_ROW_0..2; LTC_INFO", false, false,
       false},
      {"json", ".json", "the table file: everything, lossless", false, false, false, Layout::kChannels},
      {"chebyshev", ".cheb.json",
       "polynomials of some 100 coefficients, no texture; NAME.cheb.json and decoders NAME.cheb.glsl, .hlsl, "
       ".h, .js",
       false, false, true},
  };
  return list;
}

const FormatInfo* findFormat(std::string_view name) {
  for (const FormatInfo& format : formats()) {
    if (format.name == name) return &format;
  }
  return nullptr;
}

ExportResult exportTable(const Table& table, const FormatInfo& format, const FormatOptions& options,
                         const std::string& name) {
  const auto refuse = [&](const char* what) {
    throw Refusal(fmt::format("--format {} {}", format.name, what));
  };
  if (options.precision == Precision::kHalf && !format.half) refuse("holds float32 only, not half");
  if (options.layout != format.standard && !format.layouts) refuse("has one layout only");
  if (!options.prefix.empty() && !format.prefix) refuse("has no identifiers for --prefix");
  ExportResult result;
  if (format.name == "chebyshev") {
    exportChebyshev(table, options, name, result);
    return result;
  }
  const std::string prefix =
      options.prefix.empty() ? standardPrefix(table, format.name, name) : options.prefix;
  addWarnings(table, format, options, result);
  if (format.name == "json") {
    result.files = {{name, tableToJson(table)}};
    return result;
  }
  if (format.name == "h") {
    result.files = {{name, table.isIsotropic() ? tableToCHeader(table, prefix)
                                               : tableToAnisotropicCHeader(table, prefix)}};
    return result;
  }
  if (isLookup(format)) {
    const auto language = format.name == "glsl-lookup" ? ShadingLanguage::kGlsl : ShadingLanguage::kHlsl;
    result.files = {{name, makeShaderLookup(table.info(), language, prefix).source}};
    return result;
  }
  PackedTable packed = pack(table, packingFor(table, format.name, options.layout), options.precision);
  if (format.name == "hlsl" || format.name == "glsl") {
    const auto language = format.name == "glsl" ? ShadingLanguage::kGlsl : ShadingLanguage::kHlsl;
    result.files = {{name, texturesToShader(packed, prefix, language)}};
  } else if (format.name == "js") {
    std::vector<std::string> names{"LTC_MAT_1", "LTC_MAT_2"};
    if (!table.isIsotropic()) names = {"LTC_ROW_0", "LTC_ROW_1", "LTC_ROW_2"};
    result.files = {{name, texturesToModule(packed, names)}};
  } else if (format.name == "dds") {
    result.files = toDdsFiles(packed, options.ddsHeader, name);
  } else if (format.name == "ktx2") {
    result.files = toKtx2Files(packed, options.ktx2Compression, name);
  } else if (format.name == "exr") {
    result.files = toExrFiles(packed, name);
  } else if (format.name == "npy") {
    result.files = toNpyFiles(packed, name);
  } else if (format.name == "bin") {
    result.files = toRawFiles(packed, name);
  } else {
    throw std::logic_error("format without a writer");
  }
  result.half = std::move(packed.half);
  if (std::optional<std::string> warning = warningOf(result.half)) result.warnings.push_back(*warning);
  return result;
}

}  // namespace ltcfit
