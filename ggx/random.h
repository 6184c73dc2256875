// Random and quasi-random points: seeded, the same on every platform and for any number of threads.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

namespace ltcfit {

/// Additive recurrence in two dimensions with the plastic number ("R2", Roberts 2018): point i is
/// frac(shift + (i + 1) (1/rho, 1/rho^2)), rho^3 = rho + 1. Any prefix of it is evenly spread.
class R2Sequence {
 public:
  /// `seed` sets the start of the sequence (a Cranley-Patterson shift): two seeds give the same
  /// lattice at another place, so that their errors differ.
  explicit R2Sequence(std::uint64_t seed);

  /// Point `index` of the sequence, both coordinates in [0, 1).
  Eigen::Vector2d operator()(std::uint64_t index) const;

 private:
  std::uint64_t startX_;
  std::uint64_t startY_;
};

/// Mixes two integers into a well-spread third (splitmix64): makes the seed of one table entry or one light
/// out of the run's seed and a counter.
std::uint64_t mixSeed(std::uint64_t seed, std::uint64_t counter);

/// Pseudo-random numbers whose values, unlike those of the std:: distributions, are the same with every
/// standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(mixSeed(seed, 0)) {}

  /// Uniform in [0, 1), 53 bits.
  double uniform();
  /// Standard normal (Box-Muller).
  double normal();

 private:
  std::mt19937_64 engine_;
};

}  // namespace ltcfit
