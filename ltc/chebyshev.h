// An isotropic table as six short polynomials, for those who cannot ship a texture.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "ltc/table.h"

namespace ltcfit {

/// The functions of alpha and theta that are expanded. With p = alpha width,
/// psi = theta - 2 atan(alpha sin(theta) turn), e_t = (cos psi, 0, sin psi), e_n = (-sin psi, 0, cos psi):
///   M = [ p e_t + sin(theta) shear e_n | alpha cos(psi) (width + sin^2(theta) across) e_y | e_n ].
/// At normal view M is so diagonal with m00 = m11 by its form, and det M > 0 where width and
/// width + sin^2(theta) across are positive. Sharp lobes have width 2 and 0 for all others, whatever theta.
enum class ChebyshevFunction : std::size_t {
  kWidth,    ///< aperture in the plane of incidence over alpha
  kAcross,   ///< what is added to it for the aperture across, over sin^2(theta)
  kTurn,     ///< tan of half the angle from the mirror direction to e_n, over alpha sin(theta)
  kShear,    ///< over sin(theta)
  kNorm,     ///< (1 - norm) / v: norm is 1 at 90 degrees, as that of GGX
  kFresnel,  ///< fresnel - (1 - cos theta)^5, its value for alpha = 0; a negative fresnel is taken for 0
};
inline constexpr std::size_t kChebyshevFunctions = 6;
/// Name in the file: "width", "across", "turn", "shear", "norm", "fresnel".
std::string_view chebyshevFunctionName(ChebyshevFunction function);

/// What the functions are expanded over, both in [-1, 1]:
///   x = 2 sqrt(alpha) - 1,
///   s = 2 v - 1, v = cos(theta) (1 + 2 alpha) / (cos(theta) + 2 alpha).
/// Near grazing view a lobe depends on cos(theta) / alpha, so that a table changes the faster over theta the
/// smaller alpha is; over v it does not.
struct ChebyshevPoint {
  double x;
  double s;
};
/// `alpha` in (0, 1], `cosTheta` in [0, 1].
ChebyshevPoint chebyshevPoint(double alpha, double cosTheta);

/// Most terms over s and over x.
inline constexpr std::size_t kChebyshevRows = 8;
inline constexpr std::size_t kChebyshevColumns = 8;

/// rows[j][i] is the coefficient of T_j(s) T_i(x); rows may be of any length, 0 included. A row that would
/// follow the last one of its function is empty.
using ChebyshevRows = std::vector<std::vector<double>>;

struct ChebyshevForm {
  double alphaFloor = 1e-4;  ///< below it all lobes are those of the floor; in (0, 1)
  std::array<ChebyshevRows, kChebyshevFunctions> functions;
  Provenance provenance;  ///< of the table

  std::size_t coefficients() const;
  /// Sum over the rows of one function, by Clenshaw's recurrence.
  double function(ChebyshevFunction f, const ChebyshevPoint& at) const;
  /// The lobe at alphaX (alphaY and phi are not looked at), third column of unit length.
  TableEntry evaluate(const LobeParameters& parameters) const;
};

/// Throws Refusal naming what is wrong: a floor outside of (0, 1), too many rows or columns, a
/// coefficient that is not finite, and, on a grid of 65 x 65 points, values that are not finite, a width of
/// 0.01 or less (det M > 0 is lost soon after), or a tilt e_n at or below the horizon.
void checkChebyshev(const ChebyshevForm& form);

/// A table of n x n nodes on the axes of 2017, for whatever reads tables. With n = 257 the errors that
/// `ltcfit score` finds off-grid are those of 1025 nodes to 0.1 % (albedo and Fresnel 0.5 %); in the extreme
/// corner form is 5 % larger, which is interpolation and not the form's.
Table tableOfChebyshev(const ChebyshevForm& form, std::size_t n = 257);

}  // namespace ltcfit
