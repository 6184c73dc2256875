#include "export/chebyshev_source.h"

#include <fmt/format.h>

#include "export/c_text.h"
#include "export/chebyshev_text.h"
#include "export/little_endian.h"

namespace ltcfit {
namespace {

// The halves in the order of the file, and the lengths of the rows of every function.
std::string halves(const ChebyshevForm& form) {
  std::vector<std::uint16_t> bits;
  for (const ChebyshevRows& function : form.functions)
    for (const std::vector<double>& row : function)
      for (const double c : row) bits.push_back(halfBits(static_cast<float>(c)));
  std::string out;
  for (std::size_t i = 0; i < bits.size(); ++i)
    out += fmt::format("{}{}", i == 0 ? "\n  " : i % 16 == 0 ? ",\n  " : ",", bits[i]);
  return out;
}

std::string lengths(const ChebyshevForm& form, char open, char close) {
  const std::size_t rows = rowCount(form);
  std::string out;
  for (std::size_t f = 0; f < kChebyshevFunctions; ++f) {
    out += fmt::format("{}{}", f == 0 ? "" : ", ", open);
    for (std::size_t j = 0; j < rows; ++j)
      out += fmt::format("{}{}", j == 0 ? "" : ",",
                         j < form.functions[f].size() ? form.functions[f][j].size() : 0);
    out += close;
  }
  return out;
}

}  // namespace

std::string chebyshevToCHeader(const ChebyshevForm& form, const ChebyshevDifference& difference,
                               const std::string& prefix) {
  const std::string p = identifier(prefix);
  const std::string guard = upper(p) + "_CHEBYSHEV_H";
  std::string out = "/*\n" + commented(describeChebyshev(form, difference), " *") + " *\n";
  out += commented(describeTexels(), " *");
  out += fmt::format(" */\n#ifndef {0}\n#define {0}\n\n#include <math.h>\n\n", guard);
  out += fmt::format("enum {{ {}_rows = {} }};\n\n", p, rowCount(form));
  out += fmt::format(
      "/* How many coefficients each of the six functions has for each row. */\n"
      "static const unsigned char {0}_lengths[6][{0}_rows] = {{{1}}};\n\n",
      p, lengths(form, '{', '}'));
  out += fmt::format("static const unsigned short {}_halves[{}] = {{{}}};\n\n", p, form.coefficients(),
                     halves(form));
  out += fmt::format(R"(static inline float {0}_half(unsigned bits) {{
  const int exponent = (int)(bits >> 10 & 31u);
  const float digits = (float)(bits & 1023u);
  const float value = exponent > 0 ? ldexpf(1024.0f + digits, exponent - 25) : ldexpf(digits, -24);
  return (bits & 0x8000u) != 0 ? -value : value;
}}

static inline float {0}_clamp(float value, float low) {{
  return !(value > low) ? low : value < 1.0f ? value : 1.0f;
}}

/* The sums over roughness, the square root of GGX's alpha: what is left is a polynomial in N.V. */
static inline void {0}_collapse(float roughness, float shape[{0}_rows][4], float amplitude[{0}_rows][2]) {{
  const float x = 2.0f * {0}_clamp(roughness, {1}f) - 1.0f;
  const unsigned short* next = {0}_halves;
  int f, i, j;
  for (f = 0; f < 6; ++f) {{
    for (j = 0; j < {0}_rows; ++j) {{
      const int n = {0}_lengths[f][j];
      float b1 = 0.0f, b2 = 0.0f, sum = 0.0f;
      for (i = n - 1; i > 0; --i) {{
        const float b = {0}_half(next[i]) + 2.0f * x * b1 - b2;
        b2 = b1;
        b1 = b;
      }}
      if (n > 0) sum = {0}_half(next[0]) + x * b1 - b2;
      if (f < 4)
        shape[j][f] = sum;
      else
        amplitude[j][f - 4] = sum;
      next += n;
    }}
  }}
}}

/* One texel of the layout of 2017 for the roughness that was collapsed. */
static inline void {0}_texel(float shape[{0}_rows][4], float amplitude[{0}_rows][2], float roughness,
                             float n_dot_v, float t1[4], float t2[4]) {{
  const float root = {0}_clamp(roughness, {1}f);
  const float alpha = root * root;
  const float c = {0}_clamp(n_dot_v, 0.0f);
  const float v = c * (1.0f + 2.0f * alpha) / (c + 2.0f * alpha);
  const float s = 2.0f * v - 1.0f;
  const float sine = sqrtf(1.0f - c * c);
  const float u = 1.0f - c;
  float sum[6];
  float turn, scale, ct, st, cp, sp, across, ratio, middle, shear;
  int f, j;
  for (f = 0; f < 6; ++f) {{
    float b1 = 0.0f, b2 = 0.0f;
    for (j = {0}_rows - 1; j > 0; --j) {{
      const float b = (f < 4 ? shape[j][f] : amplitude[j][f - 4]) + 2.0f * s * b1 - b2;
      b2 = b1;
      b1 = b;
    }}
    sum[f] = (f < 4 ? shape[0][f] : amplitude[0][f - 4]) + s * b1 - b2;
  }}
  turn = alpha * sine * sum[2];
  scale = 1.0f / (1.0f + turn * turn);
  ct = (1.0f - turn * turn) * scale;
  st = 2.0f * turn * scale;
  cp = c * ct + sine * st;
  sp = sine * ct - c * st;
  across = sum[0] + sine * sine * sum[1];
  ratio = across * cp / sum[0];
  middle = alpha * across * cp;
  shear = ratio * sine * sum[3];
  t1[0] = ratio * cp;
  t1[1] = -(shear * cp + middle * sp);
  t1[2] = ratio * sp;
  t1[3] = middle * cp - shear * sp;
  t2[0] = 1.0f - v * sum[4];
  t2[1] = (u * u) * (u * u) * u + sum[5];
  if (t2[1] < 0.0f) t2[1] = 0.0f;
  t2[2] = 0.0f;
  t2[3] = 0.0f;
}}

/* Both textures, 4 numbers a texel, row-major; width and height at least 2. */
static inline void {0}_fill(float* t1, float* t2, int width, int height) {{
  float shape[{0}_rows][4], amplitude[{0}_rows][2];
  int x, y;
  for (x = 0; x < width; ++x) {{
    const float roughness = (float)x / (float)(width - 1);
    {0}_collapse(roughness, shape, amplitude);
    for (y = 0; y < height; ++y) {{
      const float angle = (float)y / (float)(height - 1);
      float* const a = t1 + 4 * ((long)y * width + x);
      float* const b = t2 + 4 * ((long)y * width + x);
      {0}_texel(shape, amplitude, roughness, 1.0f - angle * angle, a, b);
    }}
  }}
}}

)",
                     p, literalOfSmallestRoughness(form));
  return out + fmt::format("#endif /* {} */\n", guard);
}

std::string chebyshevToModule(const ChebyshevForm& form, const ChebyshevDifference& difference) {
  std::string out = commented(describeChebyshev(form, difference), "//") + "//\n";
  out += commented(describeTexels(), "//");
  out += fmt::format(
      "export const rows = {};\n"
      "// How many coefficients each of the six functions has for each row.\n"
      "const lengths = [{}];\n"
      "const halves = [{}\n];\n",
      rowCount(form), lengths(form, '[', ']'), halves(form));
  out += fmt::format(R"(
function half(bits) {{
  const exponent = bits >> 10 & 31;
  const digits = bits & 1023;
  const value = exponent > 0 ? (1024 + digits) * 2 ** (exponent - 25) : digits * 2 ** -24;
  return bits & 0x8000 ? -value : value;
}}

const clamp = (value, low) => Math.min(Math.max(value, low), 1);

// The sum of c[i] T_i(t), Clenshaw's recurrence; c a function of i.
function sum(n, t, c) {{
  let b1 = 0;
  let b2 = 0;
  for (let i = n - 1; i > 0; --i) [b1, b2] = [c(i) + 2 * t * b1 - b2, b1];
  return n > 0 ? c(0) + t * b1 - b2 : 0;
}}

// The sums over roughness, the square root of GGX's alpha, as arrays for uniforms: shape[rows] of 4 numbers,
// amplitude[rows] of 2. What is left is a polynomial in N.V.
export function collapse(roughness) {{
  const x = 2 * clamp(roughness, {0}) - 1;
  const shape = new Float32Array(4 * rows);
  const amplitude = new Float32Array(2 * rows);
  let next = 0;
  for (let f = 0; f < 6; ++f) {{
    for (let j = 0; j < rows; ++j) {{
      const start = next;
      const value = sum(lengths[f][j], x, i => half(halves[start + i]));
      if (f < 4) shape[4 * j + f] = value;
      else amplitude[2 * j + f - 4] = value;
      next += lengths[f][j];
    }}
  }}
  return {{ roughness, shape, amplitude }};
}}

// One texel of the layout of 2017, of what collapse returned: {{ matrix: 4 numbers, norm, fresnel }}.
export function texel({{ roughness, shape, amplitude }}, nDotV) {{
  const root = clamp(roughness, {0});
  const alpha = root * root;
  const c = clamp(nDotV, 0);
  const v = c * (1 + 2 * alpha) / (c + 2 * alpha);
  const s = 2 * v - 1;
  const sine = Math.sqrt(1 - c * c);
  const [width, addedAcross, halfTurn, addedShear] = [0, 1, 2, 3].map(f => sum(rows, s, j => shape[4 * j + f]));
  const [norm, fresnel] = [0, 1].map(f => sum(rows, s, j => amplitude[2 * j + f]));
  const turn = alpha * sine * halfTurn;
  const scale = 1 / (1 + turn * turn);
  const ct = (1 - turn * turn) * scale;
  const st = 2 * turn * scale;
  const cp = c * ct + sine * st;
  const sp = sine * ct - c * st;
  const across = width + sine * sine * addedAcross;
  const ratio = across * cp / width;
  const middle = alpha * across * cp;
  const shear = ratio * sine * addedShear;
  return {{
    matrix: [ratio * cp, -(shear * cp + middle * sp), ratio * sp, middle * cp - shear * sp],
    norm: 1 - v * norm,
    fresnel: Math.max((1 - c) ** 5 + fresnel, 0),
  }};
}}

// Both textures, RGBA, row-major; width and height at least 2.
export function textures(width = 64, height = 64) {{
  const first = new Float32Array(4 * width * height);
  const second = new Float32Array(4 * width * height);
  for (let x = 0; x < width; ++x) {{
    const collapsed = collapse(x / (width - 1));
    for (let y = 0; y < height; ++y) {{
      const entry = texel(collapsed, 1 - (y / (height - 1)) ** 2);
      const at = 4 * (y * width + x);
      first.set(entry.matrix, at);
      second.set([entry.norm, entry.fresnel], at);
    }}
  }}
  return [first, second];
}}
)",
                     literalOfSmallestRoughness(form));
  return out;
}

}  // namespace ltcfit
