#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "export/c_text.h"
#include "export/chebyshev_source.h"
#include "export/chebyshev_text.h"

namespace ltcfit {
namespace {

// A half as a literal that is a float in every language.
std::string literal(double c) {
  std::string text = fmt::format("{}", static_cast<float>(c));
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

// "x0 is 1, x1 given": declarations of the polynomials up to x{count - 1}
std::string polynomials(char name, std::size_t count) {
  std::string out;
  for (std::size_t i = 2; i < count; ++i)
    out += i == 2 ? fmt::format("  float {0}2 = 2.0 * {0}1 * {0}1 - 1.0;\n", name)
                  : fmt::format("  float {0}{1} = 2.0 * {0}1 * {0}{2} - {0}{3};\n", name, i, i - 1, i - 2);
  return out;
}

std::string sumOfRow(const std::vector<double>& row) {
  std::string out;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::string c = literal(i == 0 ? row[i] : std::abs(row[i]));
    if (i == 0) {
      out += c;
    } else {
      out += fmt::format(" {} {} * x{}", std::signbit(row[i]) ? '-' : '+', c, i);
    }
  }
  return out;
}

std::string sumOfRows(const ChebyshevRows& rows) {
  std::string out;
  for (std::size_t j = 0; j < rows.size(); ++j) {
    if (rows[j].empty()) continue;
    const std::string sum = sumOfRow(rows[j]);
    const std::string line = j == 0 ? sum : fmt::format("s{} * ({})", j, sum);
    out += out.empty() ? line : "\n      + " + line;
  }
  return out.empty() ? "0.0" : out;
}

}  // namespace

std::string chebyshevToShader(const ChebyshevForm& form, const ChebyshevDifference& difference,
                              const std::string& prefix, ShadingLanguage language) {
  const std::string name = identifier(prefix);
  const std::string guard = upper(name) + "_CHEBYSHEV_INCLUDED";
  const bool glsl = language == ShadingLanguage::kGlsl;
  const std::string vec = glsl ? "vec" : "float";
  const std::string zero4 = glsl ? "vec4(0.0)" : "(float4)0.0";
  const std::string zero2 = glsl ? "vec2(0.0)" : "(float2)0.0";
  const std::size_t rows = rowCount(form);
  std::size_t columns = 1;
  for (const ChebyshevRows& function : form.functions)
    for (const std::vector<double>& row : function) columns = std::max(columns, row.size());

  std::string out = commented(describeChebyshev(form, difference), "//");
  out += fmt::format(
      "// Include it after {}.\n"
      "#ifndef {}\n#define {}\n\n",
      glsl ? "ltc.glsl" : "ltc.hlsl", guard, guard);
  out += fmt::format("{} int {}_rows = {};\n\n", glsl ? "const" : "static const", name, rows);
  // v is a quotient of 0 by 2 alpha at 90 degrees, where alpha is not 0
  out += fmt::format(
      "// The lobe from the six functions: shape = (width, across, turn, shear), amplitude = (norm, "
      "fresnel).\n"
      "LtcEntry {0}_entry({1}4 shape, {1}2 amplitude, float alpha, float c, float v) {{\n"
      "  float sine = sqrt(max(1.0 - c * c, 0.0));\n"
      "  float turn = alpha * sine * shape.z;  // tangent of half the angle from the mirror direction\n"
      "  float scale = 1.0 / (1.0 + turn * turn);\n"
      "  float ct = (1.0 - turn * turn) * scale;\n"
      "  float st = 2.0 * turn * scale;\n"
      "  float cp = c * ct + sine * st;\n"
      "  float sp = sine * ct - c * st;\n"
      "  float across = shape.x + sine * sine * shape.y;\n"
      "  float ratio = across * cp / shape.x;\n"
      "  float middle = alpha * across * cp;\n"
      "  float shear = ratio * sine * shape.w;\n"
      "  float m00 = ratio * cp;\n"
      "  float m20 = -(shear * cp + middle * sp);\n"
      "  float m02 = ratio * sp;\n"
      "  float m22 = middle * cp - shear * sp;\n"
      "  float u = 1.0 - c;\n"
      "  LtcEntry entry;\n",
      name, vec);
  out += glsl ? "  entry.inverse = mat3(vec3(m00, 0.0, m20), vec3(0.0, 1.0, 0.0), vec3(m02, 0.0, m22));\n"
              : "  entry.inverse = float3x3(float3(m00, 0.0, m02), float3(0.0, 1.0, 0.0), float3(m20, 0.0, "
                "m22));\n";
  out +=
      "  entry.norm = 1.0 - v * amplitude.x;\n"
      "  entry.fresnel = max((u * u) * (u * u) * u + amplitude.y, 0.0);\n"
      "  return entry;\n}\n\n";
  const std::string start = fmt::format(
      "  float root = clamp(roughness, {}, 1.0);\n"
      "  float alpha = root * root;\n"
      "  float c = clamp(nDotV, 0.0, 1.0);\n"
      "  float v = c * (1.0 + 2.0 * alpha) / (c + 2.0 * alpha);\n",
      literalOfSmallestRoughness(form));
  out += fmt::format(
      "// `roughness` is the square root of GGX's alpha.\n"
      "LtcEntry {0}_fetch(float roughness, float nDotV) {{\n{1}"
      "  float x1 = 2.0 * root - 1.0;\n{2}"
      "  float s1 = 2.0 * v - 1.0;\n{3}",
      name, start, polynomials('x', columns), polynomials('s', rows));
  for (std::size_t f = 0; f < kChebyshevFunctions; ++f)
    out += fmt::format("  float {} =\n      {};\n", chebyshevFunctionName(static_cast<ChebyshevFunction>(f)),
                       sumOfRows(form.functions[f]));
  out += fmt::format(
      "  return {0}_entry({1}4(width, across, turn, shear), {1}2(norm, fresnel), alpha, c, v);\n}}\n\n"
      "// For one roughness, or few: what `collapse` of the .js file or {0}_collapse of the .h file makes of "
      "it,\n"
      "// as uniforms. Only the sums over nDotV are left.\n"
      "LtcEntry {0}_fetchCollapsed({1}4 shape[{2}], {1}2 amplitude[{2}], float roughness, float nDotV) {{\n"
      "{3}"
      "  float s = 2.0 * v - 1.0;\n"
      "  {1}4 shape1 = {4};\n  {1}4 shape2 = {4};\n  {1}2 amplitude1 = {5};\n  {1}2 amplitude2 = {5};\n"
      "  for (int j = {6}; j > 0; --j) {{\n"
      "    {1}4 shape0 = shape[j] + 2.0 * s * shape1 - shape2;\n"
      "    {1}2 amplitude0 = amplitude[j] + 2.0 * s * amplitude1 - amplitude2;\n"
      "    shape2 = shape1;\n    shape1 = shape0;\n"
      "    amplitude2 = amplitude1;\n    amplitude1 = amplitude0;\n  }}\n"
      "  return {0}_entry(shape[0] + s * shape1 - shape2, amplitude[0] + s * amplitude1 - amplitude2, alpha, "
      "c, v);\n}}\n\n",
      name, vec, rows, start, zero4, zero2, rows - 1);
  return out + fmt::format("#endif  // {}\n", guard);
}

}  // namespace ltcfit
