// What a table's look-ups are off by, over the parameters that a scene has.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tailor/interpolation_model.h"
#include "tailor/light_response.h"
#include "tailor/lobe_distribution.h"

namespace ltcfit {

/// LightResponse::difference over a sample of look-ups.
struct FetchError {
  double mean = 0.0;
  double standardError = 0.0;  ///< of the mean, as if the look-ups were independent: they are more even
  double p99 = 0.0;
  double max = 0.0;
  std::size_t singular = 0;  ///< look-ups without an inverse or a finite error, which count as infinite
  std::size_t lookUps = 0;   ///< that have a direct fit to be compared with

  /// Whether the mean is below a bound by so much that other look-ups of the same distribution would find it
  /// below as well: two standard errors.
  bool isWithin(double bound) const { return lookUps > 0 && mean + 2.0 * standardError <= bound; }
};

/// Look-ups of a distribution with a direct fit of each.
class FetchCheck {
 public:
  /// `seed` other than that of the model which the table was designed with.
  FetchCheck(const LobeDistribution& distribution, std::size_t count, const InterpolationModelOptions& fit,
             std::uint64_t seed, const FitProgress& progress = {});

  /// `table` with the numbers that a shader reads, rounded as they are shipped. Amplitudes that it does not
  /// have count as 0: whoever leaves them out knows that nothing is multiplied by them.
  FetchError measure(const Table& table) const;

  const std::vector<LookUp>& lookUps() const { return lookUps_; }
  /// One for each look-up; NaN where the lobe could not be fitted, which measure() leaves out.
  const std::vector<StoredEntry>& directFits() const { return direct_; }

 private:
  bool isotropic_;
  int threads_;
  std::uint64_t seed_;
  std::vector<LookUp> lookUps_;
  std::vector<StoredEntry> direct_;
};

}  // namespace ltcfit
