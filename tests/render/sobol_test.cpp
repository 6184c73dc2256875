#include "render/sobol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace ltcfit {
namespace {

// How many boxes of 2^-i by 2^-(k-i), for all i, do not hold just one of the 2^k points.
int boxesAmiss(const std::vector<Eigen::Vector2d>& points, int k) {
  int amiss = 0;
  for (int i = 0; i <= k; ++i) {
    std::vector<int> count(points.size(), 0);
    for (const Eigen::Vector2d& p : points) {
      const int column = static_cast<int>(std::ldexp(p.x(), i));
      const int row = static_cast<int>(std::ldexp(p.y(), k - i));
      ++count[static_cast<std::size_t>((column << (k - i)) + row)];
    }
    for (const int c : count) amiss += c != 1;
  }
  return amiss;
}

TEST(SobolPoints, EveryBoxHoldsOnePointWhateverTheSeed) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (const std::uint32_t first : {0u, 1024u, 7168u}) {
      SobolPoints sobol(seed, first);
      std::vector<Eigen::Vector2d> points;
      for (int i = 0; i < 1024; ++i) points.push_back(sobol.next());
      EXPECT_EQ(boxesAmiss(points, 10), 0) << seed << " " << first;
    }
  }
  // a lattice shifted at random is no such net
  const R2Sequence lattice(1);
  std::vector<Eigen::Vector2d> points;
  for (std::uint64_t i = 0; i < 1024; ++i) points.push_back(lattice(i));
  EXPECT_GT(boxesAmiss(points, 10), 100);
}

TEST(SobolPoints, ALaterStartContinuesTheSequence) {
  SobolPoints whole(7);
  for (int i = 0; i < 100; ++i) whole.next();
  SobolPoints later(7, 100);
  for (int i = 0; i < 500; ++i) EXPECT_EQ(whole.next(), later.next()) << i;
}

TEST(SobolPoints, EachPointIsUniformAndSeedsAreIndependent) {
  // The mean of x y over the seeds at any one place of the sequence is 1/4, and that of products of two
  // seeds' deviations 0; both within 4.5 standard errors of 20,000 seeds, for 32 places.
  constexpr int kSeeds = 20000;
  const double deviation = std::sqrt(1.0 / 9.0 - 1.0 / 16.0);
  for (const std::uint32_t place : {0u, 1u, 2u, 3u, 14u, 15u, 16u, 1000u}) {
    double mean = 0.0;
    double product = 0.0;
    double last = 0.0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const Eigen::Vector2d p = SobolPoints(seed, place).next();
      const double d = p.x() * p.y() - 0.25;
      mean += d;
      product += d * last;
      last = d;
    }
    EXPECT_LT(std::abs(mean), 4.5 * deviation * std::sqrt(kSeeds)) << place;
    EXPECT_LT(std::abs(product), 4.5 * deviation * deviation * std::sqrt(kSeeds)) << place;
  }
}

TEST(SobolPoints, SmoothIntegralsConvergeFasterThanRandomOnes) {
  // RMS error over seeds of the integral of a smooth function: n^-1.5 with Owen's scrambling
  const auto rms = [](int n) {
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      SobolPoints sobol(seed);
      double mean = 0.0;
      for (int i = 0; i < n; ++i) {
        const Eigen::Vector2d p = sobol.next();
        mean += std::exp(p.x() - 2.0 * p.y() * p.x()) / n;
      }
      sum += mean;
    }
    const double average = sum / 200.0;
    double square = 0.0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      SobolPoints sobol(seed);
      double mean = 0.0;
      for (int i = 0; i < n; ++i) {
        const Eigen::Vector2d p = sobol.next();
        mean += std::exp(p.x() - 2.0 * p.y() * p.x()) / n;
      }
      square += (mean - average) * (mean - average);
    }
    return std::sqrt(square / 200.0);
  };
  // 16 times the points: 64 times by that rate, 4 times for random ones
  EXPECT_GT(rms(64) / rms(1024), 40.0);
}

}  // namespace
}  // namespace ltcfit
