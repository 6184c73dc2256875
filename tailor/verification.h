// Whether a tailored table keeps its promise where nobody has looked before.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tailor/fetch_check.h"

namespace ltcfit {

struct VerificationOptions {
  std::size_t lookUps = 1024;     ///< for the difference to direct fits
  std::size_t truthPoints = 128;  ///< for the error against the true lobe
  std::size_t scenes = 16;        ///< random ones, drawn with the distribution's materials
  std::size_t pixels = 32;        ///< along each side of their pictures
  std::uint64_t seed = 0;         ///< other than the design's
};

/// Means of the metrics light_s, light_m and light_l.
using LightErrors = std::array<double, 3>;

struct Verification {
  FetchError tailored;  ///< difference to direct fits of the table as shipped, at unseen look-ups
  FetchError full;      ///< of the full table, as shipped
  // against the true lobes
  LightErrors directLight{};  ///< of direct fits: what no table is better than
  LightErrors tailoredLight{};
  LightErrors fullLight{};
  /// RMSE of the twin's pictures against Monte Carlo, mean over the scenes, and the latter's own error.
  double tailoredRmse = 0.0;
  double fullRmse = 0.0;
  double referenceRmse = 0.0;
  std::size_t scenes = 0;
  /// Scenes in which the tailored table's picture is farther from the reference than the full one's by more
  /// than the bound.
  std::size_t worseScenes = 0;

  bool holds(double bound) const { return tailored.mean <= bound; }
};

/// Compares `tailored` and `full`, both as shipped, over the distribution. Reflectances of the scenes'
/// surfaces are the distribution's; F90 is 1 in pictures, and where the tailored table has no Fresnel so is
/// F0. Pixels seen under other angles than the distribution's are left out.
Verification verifyTable(const Table& tailored, const Table& full, const LobeDistribution& distribution,
                         double bound, const InterpolationModelOptions& fit,
                         const VerificationOptions& options, const FitProgress& progress = {});

}  // namespace ltcfit
