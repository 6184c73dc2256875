// Distances between distributions on the sphere by their projections on lines.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace ltcfit {

/// A sample on a line, with its share of the mass.
struct WeightedPosition {
  double position;
  double weight;
};

/// Sort in ascending order (of position). Many times faster than std::sort; NaNs end up anywhere.
void sortPositions(std::vector<double>& positions);
void sortPositions(std::vector<WeightedPosition>& samples);

/// Integral of |F - G| over the line, F and G the CDFs of two sets of sorted samples; neither is empty.
/// Samples without weights have equal shares, weights sum to 1.
double cdfDistance(std::span<const double> model, std::span<const WeightedPosition> target);
double cdfDistance(std::span<const WeightedPosition> model, std::span<const WeightedPosition> target);

/// `count` directions evenly spread over the upper half of the sphere: w and -w project alike.
std::vector<Eigen::Vector3d> evenProjections(int count);

/// `count` directions of the clamped cosine, evenly spread and always the same: moved by a matrix they are
/// those of its LTC.
Eigen::Matrix3Xd evenCosineDirections(int count);

/// Mean over projections of the area between the CDFs of two sets of directions of equal shares and equal
/// number, 0..2: their sliced Wasserstein distance.
double slicedDistance(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b,
                      std::span<const Eigen::Vector3d> projections);

}  // namespace ltcfit
