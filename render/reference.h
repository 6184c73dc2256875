// The true direct light of a scene by Monte Carlo integration: what every closed form is judged by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "render/film.h"
#include "render/scene.h"

namespace ltcfit {

/// Ways to the same integral. The two single ones are there to check the estimator against itself.
enum class ReferenceSampling {
  kBoth,   ///< multiple importance sampling; light samples alone where the lobe is not narrow in the light
  kLobe,   ///< reflected visible normals only. Scenes without a diffuse base: that part is left out
  kLight,  ///< directions even over the lights only: slow for narrow lobes
};

struct ReferenceOptions {
  /// Samples of every strategy and light at a pixel: from all pixels' share up to the most that one gets.
  /// Powers of two, at least 2 `replicates`.
  std::size_t minSamples = 128;
  std::size_t maxSamples = 1u << 18;
  /// Sampling goes on, in doublings of the worst pixels, until the film's own error (ReferenceFilm::ownRmse)
  /// is not above this. >= 0; 0: every pixel with an error gets maxSamples.
  double targetRmse = 3e-4;
  /// Independent randomisations, whose spread is the error estimate. A power of two, 4..32.
  std::size_t replicates = 8;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: as OpenMP has them. The result does not depend on it
  ReferenceSampling sampling = ReferenceSampling::kBoth;

  /// Otherwise says in `error` which value is out of which range.
  bool isValid(std::string* error) const;
};

struct ReferenceFilm {
  Film film;
  /// Standard error of each pixel's radiance, RMS over the channels; 0 where it is no surface.
  std::vector<double> standardError;
  /// Root of the mean square of standardError over surface pixels; 0 without any.
  double ownRmse = 0.0;
  std::size_t surfacePixels = 0;
  double meanSamples = 0.0;    ///< per surface pixel
  bool reachedTarget = false;  ///< false: some pixels would have needed more than maxSamples
};

/// `total` counts samples and grows as it is found that pixels need more. Called by one thread at a time.
using ReferenceProgress = std::function<void(std::size_t done, std::size_t total)>;

/// At each pixel that shows a surface, summed over the lights that shine towards the point:
///   radiance texture(wi) (rho_GGX(wo, wi) F(wo.wm) + diffuse / pi) cos theta_i
/// integrated over the directions wi of the light that are above the surface's horizon, with Schlick's F.
/// Nothing casts shadows. Finite for every scene, also where lights touch surfaces. Invalid options are a
/// caller's bug and abort.
ReferenceFilm renderReference(const Scene& scene, const ReferenceOptions& options = {},
                              const ReferenceProgress& progress = {});

}  // namespace ltcfit
