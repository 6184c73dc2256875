#include "render/shader_variants.h"

#include <fmt/format.h>

#include <string_view>

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

std::string source(const Lookup& lookup, const Light& light, std::string_view skip, std::string_view shade) {
  std::string text = fmt::format("#version 450\n#define LTC_MAX_VERTICES {}\n", light.vertices);
  text += shaderText("ltc.glsl");
  text += shaderText("ltc_proxy.glsl");
  text += kHead;
  text += fmt::format(
      "void main() {{\ncolour = vec3(0.0);\n{}vec3 local[{}];\n"
      "for (int i = 0; i < {}; ++i) local[i] = frame * (corners[i] - position);\n{}{}{}}}\n",
      lookup.frame, light.vertices, light.vertices, skip, lookup.fetch, shade);
  return text;
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

std::vector<ShaderVariantCost> shaderVariantCosts() {
  std::vector<ShaderVariantCost> costs;
  for (ShaderVariant& variant : shaderVariants()) {
    const ShaderCost cost = shaderCost(variant.source);
    costs.push_back({std::move(variant), cost});
  }
  return costs;
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
