#include "fit/sliced_wasserstein.h"

#include <cmath>

#include "base/diagnostics.h"

namespace ltcfit {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void SlicedWasserstein::setTarget(std::span<const Vector3d> lobe, std::span<const Vector3d> slices) {
  samples_ = lobe.size();
  slices_.assign(slices.begin(), slices.end());
  centre_.setZero();
  for (const Vector3d& g : lobe) centre_ += g / static_cast<double>(samples_);
  target_.resize(samples_ * slices_.size());
  projections_.resize(samples_);
  for (std::size_t s = 0; s < slices_.size(); ++s) {
    for (std::size_t i = 0; i < samples_; ++i) projections_[i] = slices_[s].dot(lobe[i]);
    const std::span<const std::uint32_t> order = sorter_.order(projections_, slices_[s].dot(centre_));
    for (std::size_t i = 0; i < samples_; ++i) target_[s * samples_ + i] = projections_[order[i]];
  }
}

// The chain, backwards: L = mean |p - q|, so dL/dp = sign(p - q) / (n slices) at the sample that has the
// rank; p = w . y gives dL/dy = sum over slices of dL/dp w; y = v / |v| gives dL/dv = (I - y y^T) dL/dy /
// |v|; and v = M x gives dL/dM = dL/dv x^T.
double SlicedWasserstein::evaluate(const Matrix3d& m, std::span<const Vector3d> cosine, Matrix3d* gradient) {
  if (cosine.size() != samples_ || samples_ == 0) {
    abortWith("SlicedWasserstein: %zu cosine samples for %zu of the lobe", cosine.size(), samples_);
  }
  directions_.resize(samples_);
  invLengths_.resize(samples_);
  for (std::size_t i = 0; i < samples_; ++i) {
    const Vector3d v = m * cosine[i];
    invLengths_[i] = 1.0 / v.norm();
    directions_[i] = invLengths_[i] * v;
  }
  if (gradient != nullptr) pull_.assign(samples_, Vector3d::Zero());
  double sum = 0.0;
  for (std::size_t s = 0; s < slices_.size(); ++s) {
    const Vector3d& w = slices_[s];
    for (std::size_t i = 0; i < samples_; ++i) projections_[i] = w.dot(directions_[i]);
    const std::span<const std::uint32_t> order = sorter_.order(projections_, w.dot(centre_));
    for (std::size_t rank = 0; rank < samples_; ++rank) {
      const double difference = projections_[order[rank]] - target_[s * samples_ + rank];
      sum += std::abs(difference);
      if (gradient == nullptr || difference == 0.0) continue;
      pull_[order[rank]] += difference > 0.0 ? w : -w;
    }
  }
  const double scale = 1.0 / static_cast<double>(samples_ * slices_.size());
  if (gradient != nullptr) {
    Matrix3d g = Matrix3d::Zero();
    for (std::size_t i = 0; i < samples_; ++i) {
      const Vector3d& y = directions_[i];
      g += invLengths_[i] * (pull_[i] - y.dot(pull_[i]) * y) * cosine[i].transpose();
    }
    *gradient = scale * g;
  }
  return scale * sum;
}

}  // namespace ltcfit
