// The lobes of a material, counted.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "scene/scene_use.h"

namespace ltcfit {

/// Merges alike lobes, so that a material has at most kMaxLobes. Two are alike when they agree in
///   the roughness sqrt(alphaY)                                  to 1/255,
///   the anisotropy sqrt((alphaX - alphaY) / (1 - alphaY))       to 1/255 (of glTF; 0 is never merged with
///   more), f0 and f90                                                  to 1/16 each;
/// where that leaves more than kMaxLobes, these steps double until it does not. A merged lobe has the
/// weighted means of what it stands for: what occurs alone is kept, up to rounding. Where steps had to
/// double, the lobes of least and largest alphaX and alphaY / alphaX are kept besides, so that ranges stay.
class LobeHistogram {
 public:
  static constexpr std::size_t kMaxLobes = 4096;

  /// `lobe` in the ranges of LobeUse, its weight > 0 in any unit. Anisotropy below 1/510 becomes none.
  void add(const LobeUse& lobe);
  /// The sum of all weights.
  double weight() const { return weight_; }
  /// What was added, by growing roughness, anisotropy, f0 and f90; weights scaled to add up to `share`.
  std::vector<LobeUse> lobes(double share) const;

 private:
  std::uint32_t cellOf(const LobeUse& lobe) const;
  void coarsen();

  std::unordered_map<std::uint32_t, LobeUse> cells_;  // sums, each times its weight
  std::array<LobeUse, 4> ends_;                       // weight 0 before the first
  double weight_ = 0.0;
  unsigned level_ = 0;  // the steps are 2^level as wide
};

}  // namespace ltcfit
