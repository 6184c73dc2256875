#include "render/shader_variants.h"

#include <fmt/format.h>

#include <map>
#include <string_view>

#include "export/packing.h"
#include "export/shader_lookup.h"
#include "render/shader_text.h"

namespace ltcfit {
namespace {

constexpr std::string_view kHead = R"(
uniform sampler2D matrixTable;
uniform sampler2D amplitudeTable;
uniform sampler3D lobes;
uniform sampler2D spheres;
uniform vec3 corners[LTC_MAX_VERTICES];
uniform float roughness;
uniform vec2 alpha;
uniform vec3 f0;
uniform vec3 albedo;
in vec3 position;
in vec3 normal;
in vec3 tangent;
in vec3 view;
out vec3 colour;
)";

struct Lookup {
  std::string_view name;
  std::string_view frame;
  std::string_view fetch;
};
constexpr Lookup kLookups[] = {
    {"isotropic", "mat3 frame = ltcFrame(normal, view);\n",
     "LtcEntry entry = ltcFetch(matrixTable, amplitudeTable, roughness, dot(normal, view));\n"},
    {"anisotropic", "mat3 frame = ltcFrame(normal, tangent);\n",
     "LtcEntry entry = ltcFetchAnisotropic(lobes, ivec2(8), alpha.x, alpha.y, frame * view);\n"}};

struct Reflectance {
  std::string_view name;
  std::string_view value;
};
constexpr Reflectance kReflectances[] = {{"F0 = 1", "vec3(entry.norm)"},
                                         {"Fresnel", "ltcFresnel(entry, f0, vec3(1.0))"}};

struct Light {
  std::string_view name;
  std::string_view purpose;
  int vertices;
  std::string_view value;
};
constexpr std::string_view kFormFactor =
    "ltcVectorFormFactor(entry.inverse, local[0], local[1], local[2], local[3])";
constexpr Light kQuad{"quad", "rectangles, exact", 4,
                      "max(0.0, ltcQuad(entry.inverse, local[0], local[1], local[2], local[3]))"};
constexpr Light kLights[] = {
    kQuad,
    {"polygon of 5", "triangles to pentagons, exact", 5, "max(0.0, ltcPolygon(entry.inverse, local, 5))"},
    {"polygon of 10", "stars, disks as polygons, exact", 10,
     "max(0.0, ltcPolygon(entry.inverse, local, 10))"},
    {"quad above horizon", "lights known to be above the lobe's horizon, and the common way of quad", 4,
     "max(0.0, {}.z)"},
    {"proxy sphere", "comparison: clipped by Hill and Heitz's closed fit", 4, "ltcProxySphere({})"},
    {"proxy sphere by table", "comparison: clipped by a stored sphere", 4,
     "ltcProxySphereTable(spheres, {})"}};

// `own`: the text of a look-up beside those of ltc.glsl.
std::string source(const Lookup& lookup, const Light& light, std::string_view skip, std::string_view shade,
                   std::string_view own = "") {
  std::string text = fmt::format("#version 450\n#define LTC_MAX_VERTICES {}\n", light.vertices);
  text += shaderText("ltc.glsl");
  text += shaderText("ltc_proxy.glsl");
  text += own;
  text += kHead;
  text += fmt::format(
      "void main() {{\ncolour = vec3(0.0);\n{}vec3 local[{}];\n"
      "for (int i = 0; i < {}; ++i) local[i] = frame * (corners[i] - position);\n{}{}{}}}\n",
      lookup.frame, light.vertices, light.vertices, skip, lookup.fetch, shade);
  return text;
}

// A shader that hands out the entry, which costs nothing.
std::string aloneSource(const std::string& call, std::string_view own) {
  return fmt::format(
      "#version 450\n{}{}uniform sampler2D matrixTable;\nuniform sampler2D amplitudeTable;\n"
      "uniform sampler3D lobes;\nin float roughness;\nin float nDotV;\nin vec2 alpha;\nin vec3 view;\n"
      "out vec3 first;\nout vec3 second;\nout vec3 third;\nout vec2 amplitude;\n"
      "void main() {{\nLtcEntry entry = {};\nfirst = entry.inverse[0];\nsecond = entry.inverse[1];\n"
      "third = entry.inverse[2];\namplitude = vec2(entry.norm, entry.fresnel);\n}}\n",
      shaderText("ltc.glsl"), own, call);
}

std::string callOf(const ShaderLookup& lookup, const char* nDotV, const char* view) {
  const std::map<std::string, std::string> arguments{{"matrixTable", "matrixTable"},
                                                     {"amplitudeTable", "amplitudeTable"},
                                                     {"table", "lobes"},
                                                     {"roughness", "roughness"},
                                                     {"nDotV", nDotV},
                                                     {"alphaX", "alpha.x"},
                                                     {"alphaY", "alpha.y"},
                                                     {"view", view}};
  return lookup.call(arguments);
}

std::string specular(const Light& light, const Reflectance& reflectance) {
  const std::string value = fmt::format(fmt::runtime(light.value), kFormFactor);
  return fmt::format("colour += {} * {};\n", value, reflectance.value);
}

}  // namespace

std::vector<ShaderVariant> shaderVariants() {
  constexpr std::string_view kDiffuse =
      "colour += albedo * max(0.0, ltcQuad(mat3(1.0), local[0], local[1], local[2], local[3]));\n";
  constexpr std::string_view kSkip =
      "if (!ltcFacing(local[0], local[1], local[2]) ||\n"
      "    !ltcAboveSurface(local[0], local[1], local[2], local[3])) return;\n";
  std::vector<ShaderVariant> variants;
  for (const Lookup& lookup : kLookups) {
    for (const Reflectance& reflectance : kReflectances)
      for (const Light& light : kLights)
        variants.push_back({fmt::format("{}, {}, {}", lookup.name, reflectance.name, light.name),
                            std::string(light.purpose),
                            source(lookup, light, "", specular(light, reflectance))});
    const std::string shade = specular(kQuad, kReflectances[1]);
    variants.push_back({fmt::format("{}, Fresnel, quad, diffuse", lookup.name), "a diffuse base under it",
                        source(lookup, kQuad, "", shade + std::string(kDiffuse))});
    variants.push_back({fmt::format("{}, Fresnel, quad, skipping", lookup.name),
                        "lights seen from behind or below the surface skipped before the fetch",
                        source(lookup, kQuad, kSkip, shade)});
  }
  return variants;
}

std::vector<ShaderVariant> lookupVariants(const TableInfo& info) {
  const ShaderLookup own = makeShaderLookup(info, ShadingLanguage::kGlsl, "ltcTable");
  const Lookup& general = kLookups[info.axes.size() == 2 ? 0 : 1];
  std::vector<ShaderVariant> variants{
      {fmt::format("{}, look-up alone", general.name), "that of ltc.glsl",
       aloneSource(info.axes.size() == 2 ? "ltcFetch(matrixTable, amplitudeTable, roughness, nDotV)"
                                         : "ltcFetchAnisotropic(lobes, ivec2(8), alpha.x, alpha.y, view)",
                   "")},
      {"this table, look-up alone", "that made for the table",
       aloneSource(callOf(own, "nDotV", "view"), own.source)}};
  const std::string fetch =
      fmt::format("LtcEntry entry = {};\n", callOf(own, "dot(normal, view)", "frame * view"));
  const bool fresnel = amplitudesOf(info).size() == 2;
  for (const Reflectance& reflectance : kReflectances) {
    if (&reflectance != &kReflectances[0] && !fresnel) continue;
    variants.push_back(
        {fmt::format("this table, {}, {}", reflectance.name, kQuad.name), std::string(kQuad.purpose),
         source({"", general.frame, fetch}, kQuad, "", specular(kQuad, reflectance), own.source)});
  }
  return variants;
}

std::vector<ShaderVariantCost> costsOf(std::vector<ShaderVariant> variants) {
  std::vector<ShaderVariantCost> costs;
  for (ShaderVariant& variant : variants) {
    const ShaderCost cost = shaderCost(variant.source);
    costs.push_back({std::move(variant), cost});
  }
  return costs;
}

ShaderCost lookupCost(const TableInfo& info) {
  return shaderCost(lookupVariants(info)[1].source);
}

std::string formatShaderCosts(std::span<const ShaderVariantCost> costs) {
  std::string text =
      fmt::format("{:<44} {:>7} {:>10} {:>7} {:>8} {:>7} {:>5} {:>8}  {}\n", "variant", "fetches",
                  "arithmetic", "selects", "branches", "special", "total", "expanded", "special functions");
  for (const auto& [variant, cost] : costs) {
    std::string names;
    for (const auto& [name, n] : cost.special)
      names += fmt::format("{}{} {}", names.empty() ? "" : ", ", name, n);
    text += fmt::format("{:<44} {:>7} {:>10} {:>7} {:>8} {:>7} {:>5} {:>8}  {}\n", variant.name, cost.fetches,
                        cost.arithmetic, cost.selects, cost.branches, cost.specials(), cost.total(),
                        cost.expanded(), names);
  }
  return text;
}

}  // namespace ltcfit
