#include "fit/sgd.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "fit/lobe_samples.h"
#include "fit/sliced_wasserstein.h"
#include "ggx/random.h"
#include "ltc/ltc.h"

namespace ltcfit {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Samples for the lobe's spread, which sets the last step's length: to some percent.
constexpr int kSpreadSamples = 1024;

Vector3d randomDirection(Random& random) {
  const double z = 2.0 * random.uniform() - 1.0;
  const double phi = 2.0 * std::numbers::pi * random.uniform();
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace

bool SgdOptions::isValid(std::string* error) const {
  const auto check = [&](bool ok, const std::string& message) {
    if (!ok) *error = message;
    return ok;
  };
  return check(steps >= 1 && steps <= 10'000'000,
               "steps = " + std::to_string(steps) + ", must be in 1..1e7") &&
         check(samples >= 16 && samples <= 1 << 20,
               "samples = " + std::to_string(samples) + ", must be in 16..1048576") &&
         check(slices >= 1 && slices <= 65536,
               "slices = " + std::to_string(slices) + ", must be in 1..65536") &&
         check(firstStep > 0.0 && lastStep > 0.0, "step lengths must be positive");
}

SgdOptions paperSgdOptions() {
  SgdOptions o;
  o.steps = 10000;
  o.samples = 2048;
  o.slices = 64;
  return o;
}

SgdResult descendSlicedWasserstein(const Lobe& lobe, const Matrix3d& start, const SgdOptions& options) {
  const double meanLength =
      std::min(1.0, weightedSamples(lobe, kSpreadSamples, mixSeed(options.seed, 40)).mean().norm());
  const double spread = std::sqrt(1.0 - meanLength * meanLength);
  const double last = options.lastStep * spread;
  const double ratio = last / options.firstStep;
  const int averaged = std::max(1, options.steps / 100);

  Random random(mixSeed(options.seed, 41));
  SlicedWasserstein loss;
  std::vector<Vector3d> cosine(static_cast<std::size_t>(options.samples));
  std::vector<Vector3d> slices(static_cast<std::size_t>(options.slices));
  SgdResult result;
  result.m = start / start.col(2).norm();
  for (int step = 0; step < options.steps; ++step) {
    const std::vector<Vector3d> target = rejectionSamples(lobe, options.samples, random);
    for (Vector3d& x : cosine) {
      const double u = random.uniform();
      x = sampleCosine({u, random.uniform()});
    }
    for (Vector3d& w : slices) w = randomDirection(random);
    loss.setTarget(target, slices);
    Matrix3d gradient;
    const double value = loss.evaluate(result.m, cosine, &gradient);
    if (step < averaged) result.startLoss += value / averaged;
    if (step >= options.steps - averaged) result.loss += value / averaged;
    const double epsilon =
        options.firstStep * std::pow(ratio, static_cast<double>(step) / std::max(1, options.steps - 1));
    result.m -= epsilon * gradient;
    result.m /= result.m.col(2).norm();
    if (!result.m.allFinite()) return result;
  }
  result.finite = true;
  return result;
}

}  // namespace ltcfit
