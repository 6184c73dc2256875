#include "fit/lobe_shape.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fit/isotropic_family.h"
#include "ggx/random.h"

namespace ltcfit {
namespace {

// A start needs the widths to some 10 %.
constexpr int kSamples = 256;
// Median of |x / z| over cosine directions: a slope t has the distribution (1 + t / sqrt(1 + t^2)) / 2, so
// t / sqrt(1 + t^2) = 1/2. A narrow lobe shows the slopes; for a wide one the start is somewhat too narrow.
constexpr double kCosineMedian = 0.57735026918962576;
// A width that no lobe of interest has: keeps logarithms and ratios finite.
constexpr double kSmallestWidth = 1e-12;

struct Weighted {
  double value;
  double weight;
};

double weightedMedian(std::vector<Weighted>& v) {
  std::sort(v.begin(), v.end(), [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
  double total = 0.0;
  for (const Weighted& x : v) total += x.weight;
  double sum = 0.0;
  for (const Weighted& x : v) {
    sum += x.weight;
    if (sum >= 0.5 * total) return x.value;
  }
  return 0.0;
}

double medianDeviation(std::vector<Weighted> v) {
  const double centre = weightedMedian(v);
  for (Weighted& x : v) x.value = std::abs(x.value - centre);
  return std::max(weightedMedian(v), kSmallestWidth);
}

}  // namespace

LobeShape measureLobeShape(const Lobe& lobe, const Eigen::Vector3d& mean) {
  const Eigen::Matrix3d frame = frameAbout(mean);
  const R2Sequence points(0);
  std::vector<Weighted> x;
  std::vector<Weighted> y;
  for (int i = 0; i < kSamples; ++i) {
    const LobeSample s = lobe.sample(points(static_cast<std::uint64_t>(i)));
    if (s.weight <= 0.0) continue;
    x.push_back({frame.col(0).dot(s.wi), s.weight});
    y.push_back({frame.col(1).dot(s.wi), s.weight});
  }
  return {medianDeviation(std::move(x)), medianDeviation(std::move(y))};
}

Eigen::Matrix3d matrixOfShape(const LobeShape& shape, const Eigen::Vector3d& mean) {
  return frameAbout(mean) *
         Eigen::DiagonalMatrix<double, 3>(shape.inPlane / kCosineMedian, shape.across / kCosineMedian, 1.0);
}

}  // namespace ltcfit
