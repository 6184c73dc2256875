#include "export/shader_lookup.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/refusal.h"
#include "export/c_text.h"
#include "export/packing.h"

namespace ltcfit {
namespace {

// Words of the two languages.
struct Words {
  bool glsl;

  std::string vec(int n) const { return fmt::format("{}{}", glsl ? "vec" : "float", n); }
  std::string_view atan() const { return glsl ? "atan" : "atan2"; }
  std::string_view inverseSqrt() const { return glsl ? "inversesqrt" : "rsqrt"; }
  std::string saturate(const std::string& x) const {
    return glsl ? fmt::format("clamp({}, 0.0, 1.0)", x) : fmt::format("saturate({})", x);
  }
  std::string fetch(std::string_view table, const std::string& at) const {
    return glsl ? fmt::format("textureLod({}, {}, 0.0)", table, at)
                : fmt::format("{}.SampleLevel(bilinear, {}, 0.0)", table, at);
  }
  std::string_view sampler(int dimensions) const {
    if (glsl) return dimensions == 2 ? "sampler2D" : "sampler3D";
    return dimensions == 2 ? "Texture2D" : "Texture3D";
  }
};

// A literal that reads back to the float32 next to x.
std::string number(double x) {
  std::string text = fmt::format("{}", static_cast<float>(x));
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string signedNumber(double x) {
  return fmt::format("{} {}", std::signbit(x) ? '-' : '+', number(std::abs(x)));
}

// x factor + term; x is a name or a call.
std::string affine(const std::string& x, double factor, double term) {
  std::string text = x;
  if (static_cast<float>(factor) != 1.0f) text += fmt::format(" * {}", number(factor));
  if (static_cast<float>(term) != 0.0f) text += fmt::format(" {}", signedNumber(term));
  return text;
}

// A statement that declares `name`: scale * t + offset, t from 0 at the first node of the axis to 1 at the
// last, from the coordinate u that the axis' map yields. Not clamped without a warp: t may lie outside of
// 0..1.
std::string coordinate(const Words& words, const Axis& axis, const std::string& name, const std::string& u,
                       double scale, double offset) {
  const double low = mapCoordinate(axis.map, axis.low);
  const double width = mapCoordinate(axis.map, axis.high) - low;
  if (axis.warp == AxisWarp{})
    return fmt::format("  float {} = {};\n", name, affine(u, scale / width, offset - low * scale / width));
  // s + s (1 - s) (a + b (1 - 2 s)) by powers of s
  const auto [a, b] = axis.warp;
  const std::string even = name + "Even";
  const std::string inner = b == 0.0 ? fmt::format("{} * {}", even, number(-a * scale))
                                     : fmt::format("{0} * ({0} * {1} {2})", even, number(2.0 * b * scale),
                                                   signedNumber(-(a + 3.0 * b) * scale));
  return fmt::format("  float {} = {};\n  float {} = {} * ({} {}){};\n", even,
                     words.saturate(affine(u, 1.0 / width, -low / width)), name, even, inner,
                     signedNumber((1.0 + a + b) * scale),
                     offset == 0.0 ? std::string() : fmt::format(" {}", signedNumber(offset)));
}

// The same within a texture of the axis' nodes, in its own 0..1; where there is one node "0.5" and no
// statement.
std::string texture(const Words& words, const Axis& axis, const std::string& name, const std::string& u,
                    std::string& body) {
  if (axis.size() == 1) return "0.5";
  const double n = static_cast<double>(axis.size());
  body += coordinate(words, axis, name, u, (n - 1.0) / n, 0.5 / n);
  return name;
}

void isotropicBody(const Words& words, const TableInfo& info, const std::vector<std::string>& amplitudes,
                   std::string& body) {
  const Axis& theta = info.axes[0];
  const Axis& alpha = info.axes[1];
  const std::string x = texture(
      words, alpha, "x", alpha.map == AxisMap::kSqrt ? "roughness" : "min(roughness, 1.0) * roughness", body);
  if (theta.size() > 1 && theta.map == AxisMap::kLinear)
    body += fmt::format("  float theta = {}(sqrt(max((1.0 - nDotV) * (1.0 + nDotV), 0.0)), nDotV);\n",
                        words.atan());
  const std::string y = texture(
      words, theta, "y", theta.map == AxisMap::kLinear ? "theta" : "sqrt(max(1.0 - nDotV, 0.0))", body);
  body += fmt::format("  {0} uv = {0}({1}, {2});\n", words.vec(2), x, y);
  body += fmt::format("  {} t = {};\n", words.vec(4), words.fetch("matrixTable", "uv"));
  if (!amplitudes.empty())
    body += fmt::format("  {} a = {};\n", words.vec(4), words.fetch("amplitudeTable", "uv"));
  body += "  LtcEntry entry;\n";
  body += words.glsl
              ? "  entry.inverse = mat3(vec3(t.x, 0.0, t.y), vec3(0.0, 1.0, 0.0), vec3(t.z, 0.0, t.w));\n"
              : "  entry.inverse = float3x3(float3(t.x, 0.0, t.z), float3(0.0, 1.0, 0.0), float3(t.y, 0.0, "
                "t.w));\n";
  const bool norm = !amplitudes.empty() && amplitudes.front() == "norm";
  const bool fresnel = !amplitudes.empty() && amplitudes.back() == "fresnel";
  body += fmt::format("  entry.norm = {};\n", norm ? "a.x" : "1.0");
  body += fmt::format("  entry.fresnel = {};\n", fresnel ? (norm ? "a.y" : "a.x") : "0.0");
}

// A statement that declares uv: phi and theta of the view.
void face(const Words& words, const TableInfo& info, std::string& body) {
  const Axis& theta = info.axes[2];
  const Axis& phi = info.axes[3];
  const std::string vec2 = words.vec(2);
  if (theta.size() == 1 && phi.size() == 1) {
    body += fmt::format("  {0} uv = {0}(0.5, 0.5);\n", vec2);
    return;
  }
  body +=
      fmt::format("  {0} across = swapped ? abs({0}(view.y, view.x)) : abs({0}(view.x, view.y));\n", vec2);
  body += "  float sine = length(across);\n";
  std::string y = "0.5";
  if (theta.size() > 1 && theta.map == AxisMap::kLinear) {
    body += fmt::format("  float theta = {}(sine, max(view.z, 1e-20));\n", words.atan());
    y = texture(words, theta, "y", "theta", body);
  } else if (theta.size() > 1) {
    // sqrt(1 - cos) = sin / sqrt(1 + cos), which loses no small angles
    body += "  float up = max(view.z, 0.0);\n  float reach = sqrt(sine * sine + up * up);\n";
    y = texture(words, theta, "y",
                fmt::format("sine * {}(max(reach * (reach + up), 1e-37))", words.inverseSqrt()), body);
  }
  std::string x = "0.5";
  if (phi.size() > 1 && phi.map == AxisMap::kLinear) {
    body += fmt::format("  float phi = sine > 0.0 ? {}(across.y, across.x) : 0.0;\n", words.atan());
    x = texture(words, phi, "x", "phi", body);
  } else if (phi.size() > 1) {
    x = texture(words, phi, "x",
                fmt::format("across.y * {}(max(sine * (sine + across.x), 1e-37))", words.inverseSqrt()),
                body);
  }
  body += fmt::format("  {0} uv = {0}({1}, {2});\n", vec2, x, y);
}

void anisotropicBody(const Words& words, const TableInfo& info, const std::vector<std::string>& amplitudes,
                     std::string& body) {
  const Axis& alpha = info.axes[0];
  const Axis& lambda = info.axes[1];
  body += fmt::format(
      "  {0} flip = {0}(view.x < 0.0 ? -1.0 : 1.0, view.y < 0.0 ? -1.0 : 1.0, 1.0);\n"
      "  bool swapped = alphaY > alphaX;\n",
      words.vec(3));
  face(words, info, body);
  const auto u = [](const Axis& axis, const std::string& value) {
    return axis.map == AxisMap::kSqrt ? fmt::format("sqrt(max({}, 0.0))", value) : value;
  };
  if (alpha.size() > 1 || lambda.size() > 1) body += "  float alpha = max(alphaX, alphaY);\n";
  if (lambda.size() > 1)
    // at alpha 0 all are the same lobe, but for tables that do not go so far
    body += "  float lambda = alpha > 1e-20 ? min(alphaX, alphaY) / alpha : 1.0;\n";

  // The texture interpolates along the inner axis, the shader along the outer one. The inner one's neighbours
  // belong to another alpha or row: as ltcFetchAnisotropic, the look-up stays inside its outer texels'
  // centres.
  const Axis& inner = lambda.size() > 1 ? lambda : alpha;
  const std::string innerValue = lambda.size() > 1 ? u(lambda, "lambda") : u(alpha, "alpha");
  const double n = static_cast<double>(inner.size());
  const double depth = 3.0 * static_cast<double>(alpha.size() * lambda.size());
  if (inner.size() > 1) {
    constexpr double kInset = 3e-7;
    body += coordinate(words, inner, "w", innerValue, (n - 1.0) / depth, 0.5 / depth);
    body += fmt::format("  w = clamp(w, {}, {});\n", number(0.5 / depth + kInset),
                        number((n - 0.5) / depth - kInset));
  }
  const bool outer = alpha.size() > 1 && lambda.size() > 1;
  if (outer) {
    const double last = static_cast<double>(alpha.size() - 1);
    body += coordinate(words, alpha, "a", u(alpha, "alpha"), last, 0.0);
    body += fmt::format("  a = clamp(a, 0.0, {});\n", number(last));
    if (alpha.size() > 2) {
      body += fmt::format("  float a0 = min(floor(a), {});\n", number(last - 1.0));
      body += fmt::format("  w += a0 * {};\n  a -= a0;\n", number(n / depth));
    }
  }
  for (int row = 0; row < 3; ++row) {
    const double third = row / 3.0;
    const std::string z = inner.size() == 1 ? number(0.5 / depth + third) : affine("w", 1.0, third);
    body += fmt::format("  {} row{} = ", words.vec(4), row);
    body += outer ? fmt::format("ltcRow(table, {}uv, {}, {}, a);\n", words.glsl ? "" : "bilinear, ", z,
                                number(n / depth))
                  : words.fetch("table", fmt::format("{}(uv, {})", words.vec(3), z)) + ";\n";
  }
  body += "  LtcEntry entry = ltcEntryOfRows(row0, row1, row2, swapped, flip);\n";
  if (amplitudes.empty() || amplitudes.front() != "norm") body += "  entry.norm = 1.0;\n";
  if (amplitudes.empty() || amplitudes.back() != "fresnel") body += "  entry.fresnel = 0.0;\n";
}

std::string texturesText(const TableInfo& info, const std::vector<std::string>& amplitudes) {
  const std::vector<Axis>& axes = info.axes;
  const LeanSize single = leanSize(info, Precision::kFloat);
  const LeanSize half = leanSize(info, Precision::kHalf);
  std::string text;
  if (axes.size() == 2) {
    text = fmt::format(
        "// {} x {} texels, x = alpha, y = theta:\n//   matrixTable     RGBA: (Minv00, Minv20, "
        "Minv02, Minv22) / Minv11\n",
        axes[1].size(), axes[0].size());
    if (!amplitudes.empty())
      text += fmt::format("//   amplitudeTable  {}: {}\n", amplitudes.size() == 2 ? "RG" : "R",
                          fmt::join(amplitudes, ", "));
  } else {
    text = fmt::format(
        "// {} x {} x {} texels, RGBA, x = phi, y = theta, slice = (row * {} + alpha) * {} + lambda: a row "
        "of "
        "M{}{}\n",
        axes[3].size(), axes[2].size(), 3 * axes[0].size() * axes[1].size(), axes[0].size(), axes[1].size(),
        amplitudes.empty() ? "" : "; in w ",
        amplitudes.size() == 2    ? "norm (row 0) and fresnel (row 1)"
        : amplitudes.empty()      ? ""
        : amplitudes[0] == "norm" ? "norm (row 0)"
                                  : "fresnel (row 1)");
  }
  return text + fmt::format(
                    "// Linear filtering, clamped to the edge, no mipmaps: {} bytes in float, {} in half, "
                    "{} fetch{} a look-up.\n",
                    single.bytes, half.bytes, fetchesOf(info), fetchesOf(info) == 1 ? "" : "es");
}

std::string axesText(const TableInfo& info) {
  std::string text = "//\n// Axes; a parameter beyond the end of one is taken for the end:\n";
  for (const Axis& axis : info.axes) {
    const double degrees = axis.unit == "rad" ? 180.0 / std::numbers::pi : 1.0;
    const char* const unit = axis.unit == "rad" ? " degrees" : "";
    const double low = axis.size() == 1 ? axis.values[0] : axis.low;
    const double high = axis.size() == 1 ? axis.values[0] : axis.high;
    text += axis.size() == 1
                ? fmt::format("//   {:<6} one node at {:.6g}{}\n", axis.name, low * degrees, unit)
                : fmt::format("//   {:<6} {} nodes from {:.6g} to {:.6g}{}: {}\n", axis.name, axis.size(),
                              low * degrees, high * degrees, unit, axisFormula(axis));
  }
  return text + fmt::format("// alpha_x and alpha_y were fitted no smaller than {:.9g}.\n", info.alphaFloor);
}

std::string amplitudesText(const std::vector<std::string>& amplitudes) {
  const bool norm = !amplitudes.empty() && amplitudes.front() == "norm";
  const bool fresnel = !amplitudes.empty() && amplitudes.back() == "fresnel";
  std::string text;
  if (!norm) text += "// The table has no norm: entry.norm is 1.\n";
  if (!fresnel) text += "// The table has no fresnel: entry.fresnel is 0, which is right for F0 = F90 = 1.\n";
  return text;
}

}  // namespace

int fetchesOf(const TableInfo& info) {
  if (info.axes.size() == 2) return amplitudesOf(info).empty() ? 1 : 2;
  return info.axes[0].size() > 1 && info.axes[1].size() > 1 ? 6 : 3;
}

std::string ShaderLookup::call(const std::map<std::string, std::string>& arguments) const {
  std::string text;
  for (const std::string& parameter : parameters)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", arguments.at(parameter));
  return fmt::format("{}({})", function, text);
}

ShaderLookup makeShaderLookup(const TableInfo& info, ShadingLanguage language, const std::string& prefix) {
  for (const Axis& axis : info.axes) {
    if (axis.size() > 1 && axis.map == AxisMap::kNone)
      throw Refusal(fmt::format("axis '{}' has {} nodes and no map: a shader would have to search them",
                                axis.name, axis.size()));
  }
  const Words words{language == ShadingLanguage::kGlsl};
  const bool isotropic = info.axes.size() == 2;
  const std::string name = identifier(prefix);
  const std::vector<std::string> amplitudes = amplitudesOf(info);
  ShaderLookup lookup;
  lookup.function = name + (isotropic ? "Fetch" : "FetchAnisotropic");

  std::string declared;
  const auto parameter = [&](std::string_view type, const char* what) {
    lookup.parameters.emplace_back(what);
    declared += fmt::format("{}{} {}", declared.empty() ? "" : ", ", type, what);
  };
  parameter(words.sampler(isotropic ? 2 : 3), isotropic ? "matrixTable" : "table");
  if (isotropic && !amplitudes.empty()) parameter(words.sampler(2), "amplitudeTable");
  if (!words.glsl) parameter("SamplerState", "bilinear");
  if (isotropic) {
    if (info.axes[1].size() > 1) parameter("float", "roughness");
    if (info.axes[0].size() > 1) parameter("float", "nDotV");
  } else {
    parameter("float", "alphaX");
    parameter("float", "alphaY");
    parameter(words.vec(3), "view");
  }
  std::string body;
  if (isotropic) {
    isotropicBody(words, info, amplitudes, body);
  } else {
    anisotropicBody(words, info, amplitudes, body);
  }

  const std::string guard = upper(name) + "_LOOKUP";
  const char* const base = words.glsl ? "ltc.glsl" : "ltc.hlsl";
  lookup.source = fmt::format(
      "// Look-up of one table of Linearly Transformed Cosines, {} GGX: to be included after {} and called\n"
      "// in place of {}.\n// {}\n//\n{}{}{}\n#ifndef {}\n#define {}\n\nLtcEntry {}({}) {{\n{}  "
      "return entry;\n}}\n\n#endif  // {}\n",
      isotropic ? "isotropic" : "anisotropic", base, isotropic ? "ltcFetch" : "ltcFetchAnisotropic",
      originText(info.provenance), texturesText(info, amplitudes), axesText(info), amplitudesText(amplitudes),
      guard, guard, lookup.function, declared, body, guard);
  return lookup;
}

}  // namespace ltcfit
