#include "fit/refinement_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "ggx/random.h"

namespace ltcfit {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;
using enum AxisMap;

TableInfo infoOf(std::vector<Axis> axes) {
  TableInfo info;
  info.axes = std::move(axes);
  info.alphaFloor = 1e-4;
  return info;
}

TableInfo isotropic() {
  return infoOf({makeAxis("theta", "rad", kSqrtOneMinusCos, 8, 0.0, kHalfPi),
                 makeAxis("alpha", "1", kSqrt, 8, 0.0, 1.0, 1e-4)});
}

TableInfo anisotropic() {
  return infoOf(
      {makeAxis("alpha", "1", kSqrt, 4, 0.0, 1.0, 1e-4), makeAxis("lambda", "1", kLinear, 4, 0.0, 1.0),
       makeAxis("theta", "rad", kLinear, 4, 0.0, kHalfPi), makeAxis("phi", "rad", kLinear, 4, 0.0, kHalfPi)});
}

TableInfo partial() {
  return infoOf({makeAxis("alpha", "1", kLinear, 3, 0.1, 0.4), singleNodeAxis("lambda", "1", 0.5),
                 makeAxis("theta", "rad", kLinear, 3, 0.3, 1.1), singleNodeAxis("phi", "rad", 0.7)});
}

// Coordinates in the order of the axes.
std::vector<double> coordinates(const RefinementPoint& p, bool isIsotropic) {
  const LobeParameters& l = p.parameters;
  if (isIsotropic) return {l.theta, l.alphaX};
  return {l.alphaX, l.alphaY / l.alphaX, l.theta, l.phi};
}

TEST(RefinementPoints, LieWithinTheAxes) {
  for (const TableInfo& info : {isotropic(), anisotropic(), partial()}) {
    for (const bool crowded : {false, true}) {
      const auto points = refinementPoints(info, 2000, 3, crowded);
      ASSERT_EQ(points.size(), 2000u);
      std::vector<double> least(info.axes.size(), 10.0);
      std::vector<double> most(info.axes.size(), -10.0);
      for (const RefinementPoint& p : points) {
        EXPECT_FALSE(p.isNode);
        EXPECT_GE(std::min(p.parameters.alphaX, p.parameters.alphaY), info.alphaFloor);
        EXPECT_GE(p.parameters.alphaX, p.parameters.alphaY);
        const std::vector<double> at = coordinates(p, info.axes.size() == 2);
        for (std::size_t a = 0; a < at.size(); ++a) {
          least[a] = std::min(least[a], at[a]);
          most[a] = std::max(most[a], at[a]);
        }
      }
      for (std::size_t a = 0; a < info.axes.size(); ++a) {
        const std::vector<double>& values = info.axes[a].values;
        const double length = values.back() - values.front();
        // lambda = (alpha lambda) / alpha
        EXPECT_GE(least[a], values.front() - 1e-15);
        EXPECT_LE(most[a], values.back() + 1e-15);
        // and reach to both ends: 2000 points leave no gap of 3 %
        EXPECT_LE(least[a], values.front() + 0.03 * length);
        EXPECT_GE(most[a], values.back() - 0.03 * length);
      }
    }
  }
}

// Measures in which points are even, each mapped to 0..1.
std::vector<std::array<double, 4>> evenCoordinates(const TableInfo& info,
                                                   const std::vector<RefinementPoint>& points) {
  const bool isIsotropic = info.axes.size() == 2;
  std::vector<std::array<double, 4>> out;
  for (const RefinementPoint& p : points) {
    const std::vector<double> at = coordinates(p, isIsotropic);
    std::array<double, 4> u{};
    for (std::size_t a = 0; a < at.size(); ++a) {
      const AxisMap map = !isIsotropic ? kLinear : a == 0 ? kSqrtOneMinusCos : kSqrt;
      const double low = mapCoordinate(map, info.axes[a].values.front());
      const double high = mapCoordinate(map, info.axes[a].values.back());
      u[a] = (mapCoordinate(map, at[a]) - low) / (high - low);
    }
    out.push_back(u);
  }
  return out;
}

// Root mean square, over random boxes with a corner at 0, of the share of points in them less their volume.
double discrepancy(const std::vector<std::array<double, 4>>& points, std::size_t dims) {
  Random random(9);
  double squares = 0.0;
  constexpr int kBoxes = 300;
  for (int b = 0; b < kBoxes; ++b) {
    std::array<double, 4> corner{};
    double volume = 1.0;
    for (std::size_t a = 0; a < dims; ++a) volume *= corner[a] = random.uniform();
    double inside = 0.0;
    for (const auto& p : points) {
      bool in = true;
      for (std::size_t a = 0; a < dims; ++a) in = in && p[a] < corner[a];
      inside += in ? 1.0 : 0.0;
    }
    const double off = inside / static_cast<double>(points.size()) - volume;
    squares += off * off;
  }
  return std::sqrt(squares / kBoxes);
}

TEST(RefinementPoints, AreSpreadMoreEvenlyThanRandomOnes) {
  for (const TableInfo& info : {isotropic(), anisotropic()}) {
    const std::size_t dims = info.axes.size();
    Random random(4);
    std::vector<std::array<double, 4>> independent(2000);
    for (auto& p : independent)
      for (double& x : p) x = random.uniform();
    const double of = discrepancy(independent, dims);
    // of 0.66 in four dimensions; the boxes are as random as the points they are compared with
    EXPECT_LT(discrepancy(evenCoordinates(info, refinementPoints(info, 2000, 7, false)), dims),
              (dims == 2 ? 0.5 : 0.8) * of);
    if (dims == 4) {
      const double crowded = discrepancy(evenCoordinates(info, refinementPoints(info, 2000, 7, true)), dims);
      EXPECT_GT(crowded, of) << "crowded points are not even";
    }
  }
}

TEST(RefinementPoints, WeightsMakeUpForCrowding) {
  const TableInfo info = anisotropic();
  for (const RefinementPoint& p : refinementPoints(info, 100, 1, false)) EXPECT_EQ(p.weight, 1.0);

  // sums over boxes: of points, of their weights, and of the domain
  const auto points = refinementPoints(info, 20000, 1, true);
  const auto even = evenCoordinates(info, points);
  double total = 0.0;
  for (const RefinementPoint& p : points) total += p.weight;
  const auto shares = [&](std::size_t axis, bool lowEnd, double part, double* weight) {
    double count = 0.0;
    *weight = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (lowEnd ? even[i][axis] > part : even[i][axis] < 1.0 - part) continue;
      count += 1.0;
      *weight += points[i].weight;
    }
    *weight /= total;
    return count / static_cast<double>(points.size());
  };
  // sharp alpha, small lambda, grazing theta: more points, together of the domain's share
  const std::array<bool, 3> lowEnds{true, true, false};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double weight = 0.0;
    const double count = shares(axis, lowEnds[axis], 0.2, &weight);
    EXPECT_GT(count, 1.2 * weight) << axis;
    EXPECT_NEAR(weight, 0.2, 3e-3) << axis;
    EXPECT_LT(shares(axis, !lowEnds[axis], 0.2, &weight), 0.2);
    EXPECT_NEAR(weight, 0.2, 3e-3) << axis;
  }
  // phi is left even: within what 20000 points resolve
  double weight = 0.0;
  EXPECT_NEAR(shares(3, true, 0.2, &weight), 0.2, 2e-3);
  EXPECT_NEAR(weight, 0.2, 2e-3);
  const double mean = total / static_cast<double>(points.size());
  EXPECT_NEAR(mean, 1.0, 5e-3);
}

TEST(RefinementPoints, AnAxisOfOneNodeHasNothingToCrowd) {
  const TableInfo info =
      infoOf({singleNodeAxis("alpha", "1", 0.3), singleNodeAxis("lambda", "1", 0.5),
              singleNodeAxis("theta", "rad", 0.8), makeAxis("phi", "rad", kLinear, 3, 0.0, kHalfPi)});
  for (const RefinementPoint& p : refinementPoints(info, 100, 1, true)) EXPECT_EQ(p.weight, 1.0);
}

TEST(RefinementPoints, AreGivenByTheSeed) {
  const auto a = refinementPoints(anisotropic(), 50, 1, true);
  const auto b = refinementPoints(anisotropic(), 50, 1, true);
  const auto c = refinementPoints(anisotropic(), 50, 2, true);
  const auto longer = refinementPoints(anisotropic(), 60, 1, true);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(coordinates(a[i], false), coordinates(b[i], false));
    EXPECT_EQ(a[i].weight, b[i].weight);
    EXPECT_NE(coordinates(a[i], false), coordinates(c[i], false));
    EXPECT_EQ(coordinates(a[i], false), coordinates(longer[i], false)) << "a prefix";
  }
}

}  // namespace
}  // namespace ltcfit
