#include "report/projections.h"

#include <hwy/contrib/sort/vqsort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "ltc/ltc.h"

namespace ltcfit {
namespace {

// Stateless for the caller; a sorter is cheap to make but for its first random seed.
hwy::Sorter& sorter() {
  thread_local hwy::Sorter instance;
  return instance;
}

// Doubles in the order of unsigned integers: negative ones reversed, positive ones above them. Own inverse in
// two halves, as the top bit says which.
constexpr std::uint64_t kSign = std::uint64_t{1} << 63;

std::uint64_t keyOf(double v) {
  const auto bits = std::bit_cast<std::uint64_t>(v);
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}

double fromKey(std::uint64_t key) {
  return std::bit_cast<double>((key & kSign) != 0 ? key & ~kSign : ~key);
}

// A point of a lattice over the unit square: the golden ratio's multiples against even steps.
Eigen::Vector2d latticePoint(int i, int n) {
  return {(i + 0.5) / n, std::fmod((i + 0.5) / std::numbers::phi, 1.0)};
}

// Over the merged positions. `position` and `share` say where sample i of the model is and what it weighs.
template <typename Position, typename Share>
double areaBetween(std::size_t n, Position position, Share share, std::span<const WeightedPosition> target) {
  std::size_t i = 0;
  std::size_t j = 0;
  double sum = 0.0;
  double difference = 0.0;  // F - G left of the next position
  double previous = std::min(position(0), target[0].position);
  while (i < n || j < target.size()) {
    const bool takeModel = j == target.size() || (i < n && position(i) <= target[j].position);
    const double next = takeModel ? position(i) : target[j].position;
    sum += std::abs(difference) * (next - previous);
    previous = next;
    difference += takeModel ? share(i) : -target[j].weight;
    takeModel ? ++i : ++j;
  }
  return sum;
}

}  // namespace

void sortPositions(std::vector<double>& positions) {
  sorter()(positions.data(), positions.size(), hwy::SortAscending());
}

void sortPositions(std::vector<WeightedPosition>& samples) {
  thread_local std::vector<hwy::K64V64> keys;
  keys.resize(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    keys[i].key = keyOf(samples[i].position);
    keys[i].value = std::bit_cast<std::uint64_t>(samples[i].weight);
  }
  sorter()(keys.data(), keys.size(), hwy::SortAscending());
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = {fromKey(keys[i].key), std::bit_cast<double>(keys[i].value)};
}

double cdfDistance(std::span<const double> model, std::span<const WeightedPosition> target) {
  const double equal = 1.0 / static_cast<double>(model.size());
  return areaBetween(
      model.size(), [&](std::size_t i) { return model[i]; }, [&](std::size_t) { return equal; }, target);
}

double cdfDistance(std::span<const WeightedPosition> model, std::span<const WeightedPosition> target) {
  return areaBetween(
      model.size(), [&](std::size_t i) { return model[i].position; },
      [&](std::size_t i) { return model[i].weight; }, target);
}

std::vector<Eigen::Vector3d> evenProjections(int count) {
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d u = latticePoint(i, count);
    const double radius = std::sqrt(1.0 - u.x() * u.x());
    const double azimuth = 2.0 * std::numbers::pi * u.y();
    out.emplace_back(radius * std::cos(azimuth), radius * std::sin(azimuth), u.x());
  }
  return out;
}

Eigen::Matrix3Xd evenCosineDirections(int count) {
  Eigen::Matrix3Xd x(3, count);
  for (int i = 0; i < count; ++i) x.col(i) = sampleCosine(latticePoint(i, count));
  return x;
}

double slicedDistance(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b,
                      std::span<const Eigen::Vector3d> projections) {
  std::vector<double> p(static_cast<std::size_t>(a.cols()));
  std::vector<double> q(p.size());
  const auto n = static_cast<Eigen::Index>(p.size());
  double sum = 0.0;
  for (const Eigen::Vector3d& w : projections) {
    Eigen::Map<Eigen::RowVectorXd>(p.data(), n) = w.transpose() * a;
    Eigen::Map<Eigen::RowVectorXd>(q.data(), n) = w.transpose() * b;
    sortPositions(p);
    sortPositions(q);
    double difference = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) difference += std::abs(p[i] - q[i]);
    sum += difference / static_cast<double>(n);
  }
  return sum / static_cast<double>(projections.size());
}

}  // namespace ltcfit
