#include "report/smoothness.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "base/parallel_for.h"
#include "fit/target_lobe.h"
#include "ggx/random.h"
#include "report/projections.h"

namespace ltcfit {
namespace {

constexpr int kStepDirections = 256;
constexpr int kStepProjections = 16;
// The points are those of one sequence for every lobe, so that neighbours share their noise.
constexpr std::uint64_t kSeed = 1;

struct TrueLobe {
  Eigen::Matrix3Xd directions;
  std::vector<double> weights;  // sum to 1
  double spread = 0.0;
};

TrueLobe trueLobe(const Table& table, std::size_t flat) {
  const std::unique_ptr<Lobe> lobe = makeTargetLobe(table.info().brdf, table.parameters(table.node(flat)));
  const R2Sequence points(mixSeed(kSeed, 31));
  TrueLobe out{Eigen::Matrix3Xd(3, kStepDirections), std::vector<double>(kStepDirections), 0.0};
  double total = 0.0;
  for (int i = 0; i < kStepDirections; ++i) {
    const LobeSample s = lobe->sample(points(static_cast<std::uint64_t>(i)));
    out.directions.col(i) = s.wi;
    out.weights[static_cast<std::size_t>(i)] = s.weight;
    total += s.weight;
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i = 0; i < kStepDirections; ++i) {
    double& weight = out.weights[static_cast<std::size_t>(i)];
    weight /= total;
    mean += weight * out.directions.col(i);
  }
  // acos |mean| without the cancellation of 1 - |mean|: that is half the mean squared chord to its direction
  mean.normalize();
  double chord = 0.0;
  for (int i = 0; i < kStepDirections; ++i)
    chord += out.weights[static_cast<std::size_t>(i)] * (out.directions.col(i) - mean).squaredNorm();
  out.spread = 2.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(chord)));
  return out;
}

class Distances {
 public:
  // The lobe of a matrix as directions.
  Eigen::Matrix3Xd lobe(const Eigen::Matrix3d& m) const { return (m * cosine_).colwise().normalized(); }

  double between(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) const {
    return slicedDistance(a, b, projections_);
  }

  // Distance of two true lobes, whose directions have weights.
  double between(const TrueLobe& a, const TrueLobe& b) const {
    std::vector<WeightedPosition> p(a.weights.size());
    std::vector<WeightedPosition> q(b.weights.size());
    double sum = 0.0;
    for (const Eigen::Vector3d& w : projections_) {
      for (std::size_t i = 0; i < p.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        p[i] = {w.dot(a.directions.col(k)), a.weights[i]};
        q[i] = {w.dot(b.directions.col(k)), b.weights[i]};
      }
      sortPositions(p);
      sortPositions(q);
      sum += cdfDistance(p, q);
    }
    return sum / static_cast<double>(projections_.size());
  }

 private:
  Eigen::Matrix3Xd cosine_ = evenCosineDirections(kStepDirections);
  std::vector<Eigen::Vector3d> projections_ = evenProjections(kStepProjections);
};

}  // namespace

std::vector<AxisSmoothness> tableSmoothness(const Table& table, int threads) {
  const std::size_t nodes = table.nodeCount();
  const std::vector<Axis>& axes = table.info().axes;
  const bool inverse = table.info().stores == MatrixStorage::kMinv;
  const Distances distances;
  std::vector<TrueLobe> truth(nodes);
  std::vector<AxisSmoothness> out(axes.size());
  for (std::size_t a = 0; a < axes.size(); ++a)
    out[a] = {axes[a].name, std::vector<double>(nodes, std::nan("")), {}};
  const ParallelOptions parallel{.threads = threads, .chunk = 16};
  parallelFor(nodes, parallel, [&](std::size_t i) { truth[i] = trueLobe(table, i); });
  parallelFor(nodes, parallel, [&](std::size_t i) {
    const std::vector<std::size_t> node = table.node(i);
    const TableEntry here = table.entry(node);
    const Eigen::Matrix3Xd lobe = distances.lobe(here.m);
    std::size_t stride = nodes;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      stride /= axes[a].size();
      if (node[a] + 1 == axes[a].size()) continue;
      const std::size_t j = i + stride;
      const TableEntry next = table.entry(table.node(j));
      const Eigen::Matrix3d stored =
          0.5 * (inverse ? Eigen::Matrix3d(here.mInv + next.mInv) : Eigen::Matrix3d(here.m + next.m));
      const Eigen::Matrix3d other = stored.inverse();
      const bool usable =
          here.invertible && next.invertible && std::abs(stored.determinant()) > 0.0 && other.allFinite();
      if (!usable) {
        out[a].steps[i] = std::numeric_limits<double>::infinity();
        continue;
      }
      const Eigen::Matrix3Xd half = distances.lobe(inverse ? other : stored);
      const double travel = distances.between(lobe, half) + distances.between(half, distances.lobe(next.m));
      const double width = std::max(truth[i].spread, truth[j].spread);
      out[a].steps[i] = std::max(0.0, travel - distances.between(truth[i], truth[j])) / width;
    }
  });
  for (AxisSmoothness& axis : out) {
    std::vector<double> steps;
    std::copy_if(axis.steps.begin(), axis.steps.end(), std::back_inserter(steps),
                 [](double v) { return !std::isnan(v); });
    axis.summary = summarize(std::move(steps));
  }
  return out;
}

}  // namespace ltcfit
