#include "ggx/random.h"

#include <cmath>
#include <numbers>

namespace ltcfit {
namespace {

// 2^64 / rho and 2^64 / rho^2, rho = 1.32471795724474602596 (the plastic number), rounded to odd: the
// recurrence is exact in 64-bit integers, so that point 10^9 is as well placed as point 1.
constexpr std::uint64_t kStepX = 0xC13FA9A902A6328Full;
constexpr std::uint64_t kStepY = 0x91E10DA5C79E7B1Dull;

double toUnit(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

}  // namespace

std::uint64_t mixSeed(std::uint64_t seed, std::uint64_t counter) {
  std::uint64_t z = seed + 0x9E3779B97F4A7C15ull * (counter + 1);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

R2Sequence::R2Sequence(std::uint64_t seed) : startX_(mixSeed(seed, 1)), startY_(mixSeed(seed, 2)) {}

Eigen::Vector2d R2Sequence::operator()(std::uint64_t index) const {
  return {toUnit(startX_ + (index + 1) * kStepX), toUnit(startY_ + (index + 1) * kStepY)};
}

double Random::uniform() {
  return toUnit(engine_());
}

double Random::normal() {
  const double u = 1.0 - uniform();  // in (0, 1]: the logarithm stays finite
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * uniform());
}

}  // namespace ltcfit
