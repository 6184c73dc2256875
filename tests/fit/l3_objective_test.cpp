#include "fit/l3_objective.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "ggx/ggx_lobe.h"
#include "ggx/moments.h"
#include "ltc/ltc.h"
#include "tests/support/ltc_lobe.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// integral over the sphere of |rho cos - n_D f|^3 by the midpoint rule in cos theta and phi
double bruteForce(const Lobe& lobe, double albedo, const Matrix3d& m) {
  const Ltc ltc(m);
  const int n = 1500;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double z = 2.0 * (i + 0.5) / n - 1.0;
    const double r = std::sqrt(1.0 - z * z);
    for (int j = 0; j < n; ++j) {
      const double phi = 2.0 * std::numbers::pi * (j + 0.5) / n;
      const Vector3d w(r * std::cos(phi), r * std::sin(phi), z);
      sum += std::pow(std::abs(lobe.eval(w) - albedo * ltc.density(w)), 3);
    }
  }
  return sum * 4.0 * std::numbers::pi / (static_cast<double>(n) * n);
}

TEST(L3Objective, AgreesWithBruteForce) {
  const GgxLobe lobe(viewDirection(1.1, 0.0), {0.4, 0.4});
  const double albedo = computeMoments(lobe).albedo;
  const L3Objective objective(lobe, albedo, 1 << 16, 3);
  Matrix3d near = Vector3d(0.45, 0.4, 1.0).asDiagonal();
  near = Eigen::AngleAxisd(-0.9, Vector3d::UnitY()).toRotationMatrix() * near;
  Matrix3d far;
  far << 1.0, 0.2, -0.3, 0.1, 0.8, 0.0, 0.3, 0.0, 0.9;  // all entries, part below the horizon
  for (const Matrix3d& m : {near, far, Matrix3d(Matrix3d::Identity())}) {
    const double expected = bruteForce(lobe, albedo, m);
    EXPECT_NEAR(objective(m) / expected, 1.0, 5e-3);  // 65,536 points
  }
}

TEST(L3Objective, IsZeroForTheLobeItself) {
  Matrix3d m;
  m << 0.3, 0, -0.5, 0, 0.2, 0, 0.1, 0, 1;
  const test::LtcLobe lobe(m, 0.7);
  const L3Objective objective(lobe, 0.7, 1000, 1);
  EXPECT_NEAR(objective(m), 0.0, 1e-30);
  EXPECT_NEAR(objective(5.0 * m), 0.0, 1e-30);  // no scale
  EXPECT_GT(objective(Matrix3d::Identity()), 0.01);
}

TEST(L3Objective, LobeCubeIsTheCostOfNoLight) {
  const GgxLobe lobe(viewDirection(0.6, 0.0), {0.3, 0.3});
  const L3Objective objective(lobe, computeMoments(lobe).albedo, 1 << 14, 2);
  EXPECT_NEAR(objective.lobeCube() / bruteForce(lobe, 0.0, Matrix3d::Identity()), 1.0, 1e-2);
}

TEST(L3Objective, SharpLobesDoNotOverflow) {
  for (double alpha : {1e-5, 1e-4}) {
    for (double theta : {0.0, 1.5, 0.5 * std::numbers::pi}) {
      const GgxLobe lobe(viewDirection(theta, 0.0), {alpha, alpha});
      const L3Objective objective(lobe, 1.0, 1024, 1);
      EXPECT_TRUE(std::isfinite(objective(Matrix3d::Identity())));
      EXPECT_TRUE(std::isfinite(objective.lobeCube()));
      EXPECT_GT(objective.lobeCube(), 0.0);
    }
  }
}

TEST(L3Objective, ASingularMatrixIsInfinitelyBad) {
  const GgxLobe lobe(viewDirection(0.6, 0.0), {0.3, 0.3});
  const L3Objective objective(lobe, 0.9, 64, 2);
  EXPECT_TRUE(std::isinf(objective(Vector3d(1, 0, 1).asDiagonal())));
  EXPECT_TRUE(std::isinf(objective(Vector3d(1, std::nan(""), 1).asDiagonal())));
}

}  // namespace
}  // namespace ltcfit
