// Expanding a table into short polynomials.
#pragma once

#include <functional>

#include "ltc/chebyshev.h"

namespace ltcfit {

struct ChebyshevOptions {
  /// Coefficients in all, for the six functions together; from kLeastCoefficients to kMostCoefficients.
  std::size_t coefficients = 160;
  /// What the coefficients are rounded to; none: they stay as they are.
  std::function<double(double)> round;
};
inline constexpr std::size_t kLeastCoefficients = 48;
/// More follow the scatter of the sharpest fits at grazing view, until a lobe of them is turned inside out.
inline constexpr std::size_t kMostCoefficients = 320;

/// How far a form is from a table, at its nodes from alpha 0.002 on.
struct ChebyshevDifference {
  /// RMS distance between the directions M x / |M x| of the two lobes, x from the cosine, over the lobe's
  /// spread (acos of the length of its mean direction).
  double meanShift = 0.0;
  double largestShift = 0.0;
  double meanNorm = 0.0;
  double largestNorm = 0.0;
  double meanFresnel = 0.0;
  double largestFresnel = 0.0;
};
/// `table` as for fitChebyshev.
ChebyshevDifference chebyshevDifference(const ChebyshevForm& form, const Table& table);

/// Weighted least squares over the nodes, each by the area around it in (sqrt(alpha), sqrt(1 - cos theta)).
/// What is minimised is the squared shift of the lobe to first order, plus the squared errors of norm and
/// Fresnel. Terms are chosen one row's next one to three at a time, those that lower the sum most for each
/// coefficient, with all others free; rounding goes backwards through the triangular system, so that what
/// one loses the next ones take up. Throws Refusal for an anisotropic table, one over a part of
/// alpha and theta, without norm and Fresnel, an alpha floor of 0, entries off the plane of incidence or
/// without an inverse, lobes that lean below the horizon, more coefficients than three a node, and too few
/// coefficients to keep det M > 0 everywhere (checkChebyshev).
ChebyshevForm fitChebyshev(const Table& table, const ChebyshevOptions& options = {});

}  // namespace ltcfit
