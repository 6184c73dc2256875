#include "fit/lobe_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ltcfit {

using Eigen::Vector3d;

namespace {

void normalize(std::vector<double>& weights) {
  double total = 0.0;
  for (double w : weights) total += w;
  for (double& w : weights) w /= total;
}

}  // namespace

Vector3d LobeSamples::mean() const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < directions.size(); ++i) sum += weights[i] * directions[i];
  return sum;
}

LobeSamples weightedSamples(const Lobe& lobe, int count, std::uint64_t seed) {
  // The first coordinate of a lobe's sample goes from its core at 0 to its tail at 1: 1 - u = v^b, of measure
  // b v^(b - 1) dv. With z^2 = 1 - u, as for the cosine, z = v^(b / 2).
  constexpr double b = 2.0 * kTailExponent;
  constexpr double kLargestBelowOne = 1.0 - 1.2e-16;
  const R2Sequence points(seed);
  LobeSamples out;
  out.directions.reserve(static_cast<std::size_t>(count));
  out.weights.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d u = points(static_cast<std::uint64_t>(i));
    const double v = 1.0 - u.x();
    const double power = std::pow(v, b - 1.0);
    const LobeSample s = lobe.sample({std::min(1.0 - power * v, kLargestBelowOne), u.y()});
    const double weight = s.weight * b * power;
    if (!(weight > 0.0)) continue;
    out.directions.push_back(s.wi);
    out.weights.push_back(weight);
  }
  normalize(out.weights);
  return out;
}

std::vector<Vector3d> rejectionSamples(const Lobe& lobe, int count, Random& random) {
  std::vector<Vector3d> out;
  out.reserve(static_cast<std::size_t>(count));
  while (out.size() < static_cast<std::size_t>(count)) {
    const double u = random.uniform();
    const LobeSample s = lobe.sample({u, random.uniform()});
    if (random.uniform() < s.weight) out.push_back(s.wi);
  }
  return out;
}

LobeSamples cosineSamples(int count, std::uint64_t seed) {
  Random random(seed);
  const double turn = random.uniform();
  LobeSamples out;
  for (int i = 0; i < count; ++i) {
    const double v = (i + 0.5) / count;
    const double z = std::pow(v, kTailExponent);
    const double r = std::sqrt(1.0 - z * z);
    const double phi = 2.0 * std::numbers::pi * std::fmod(turn + i * (std::numbers::phi - 1.0), 1.0);
    out.directions.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
    // density of the cosine, 2 z dz, over that of the lattice, dv
    out.weights.push_back(2.0 * kTailExponent * z * z / v);
  }
  normalize(out.weights);
  return out;
}

}  // namespace ltcfit
