#include "export/chebyshev_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "export/c_text.h"
#include "export/chebyshev_file.h"

namespace ltcfit {

std::size_t rowCount(const ChebyshevForm& form) {
  std::size_t rows = 1;
  for (const ChebyshevRows& function : form.functions) rows = std::max(rows, function.size());
  return rows;
}

std::vector<std::string> describeChebyshev(const ChebyshevForm& form, const ChebyshevDifference& d) {
  return {
      "Linearly Transformed Cosines for isotropic GGX (height-correlated Smith, F = 1) as polynomials.",
      originText(form.provenance),
      fmt::format("{} coefficients, {} bytes as halves. Against the table: lobes shifted by {:.4f} of their",
                  form.coefficients(), form.coefficients() * kCoefficientBytes, d.meanShift),
      fmt::format("spread (largest {:.3f}), norm off by {:.5f} ({:.4f}), Fresnel by {:.5f} ({:.4f}).",
                  d.largestShift, d.meanNorm, d.largestNorm, d.meanFresnel, d.largestFresnel),
      fmt::format("Below alpha {:.9g} all lobes are those of that alpha.", form.alphaFloor),
      "Shading frame: z = normal, the view vector in the x-z plane with x >= 0; the lobe leans to -x."};
}

std::string commented(const std::vector<std::string>& lines, const char* start) {
  std::string out;
  for (const std::string& line : lines) out += fmt::format("{} {}\n", start, line);
  return out;
}

const std::vector<std::string>& describeTexels() {
  static const std::vector<std::string> lines{
      "texel (x, y): x = roughness = sqrt(alpha), y = sqrt(1 - N.V), both from 0 to 1 over the texels;",
      "first texture (Minv00, Minv20, Minv02, Minv22) / Minv11, second (norm, fresnel, 0, 0).",
      "For clamping, linear filtering: uv = (x, y) * (size - 1) / size + 0.5 / size."};
  return lines;
}

std::string literalOfSmallestRoughness(const ChebyshevForm& form) {
  return fmt::format("{:.9g}", std::sqrt(form.alphaFloor));
}

}  // namespace ltcfit
