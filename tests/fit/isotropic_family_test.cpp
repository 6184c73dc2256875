#include "fit/isotropic_family.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const Vector3d kMean(-0.7, 0.0, 0.6);

Matrix3d scaledLike(const Matrix3d& m, const Matrix3d& reference) {
  return m * (reference.norm() / m.norm());
}

TEST(IsotropicFamily, TheStartIsReproduced) {
  Matrix3d general;
  general << 0.3, 0, -0.8, 0, 0.2, 0, 0.15, 0, 0.7;
  const IsotropicParametrization four(IsotropicFamily::kPlane4, false, kMean, general);
  EXPECT_EQ(four.start().size(), 4u);
  EXPECT_LT((scaledLike(four.matrix(four.start()), general) - general).norm(), 1e-12);

  Matrix3d local;
  local << 0.3, 0, 0.1, 0, 0.2, 0, 0, 0, 1;
  const Matrix3d inFrame = frameAbout(kMean) * local;
  const IsotropicParametrization three(IsotropicFamily::kMeanFrame3, false, kMean, inFrame);
  EXPECT_EQ(three.start().size(), 3u);
  EXPECT_LT((scaledLike(three.matrix(three.start()), inFrame) - inFrame).norm(), 1e-12);

  const IsotropicParametrization one(IsotropicFamily::kPlane4, true, Vector3d::UnitZ(),
                                     2.0 * Matrix3d::Identity());
  EXPECT_EQ(one.start().size(), 1u);
  EXPECT_LT((one.matrix(one.start()) - Matrix3d::Identity()).norm(), 1e-12);
}

TEST(IsotropicFamily, KeepsItsZerosAndOrientation) {
  for (IsotropicFamily family : {IsotropicFamily::kPlane4, IsotropicFamily::kMeanFrame3}) {
    const IsotropicParametrization p(family, false, kMean, Matrix3d::Identity());
    std::vector<double> v = p.start();
    for (double step : {-3.0, -0.2, 0.4, 3.0}) {
      for (double& x : v) x += step;
      const Matrix3d m = p.matrix(v);
      EXPECT_EQ(m(0, 1), 0.0);
      EXPECT_EQ(m(1, 0), 0.0);
      EXPECT_EQ(m(1, 2), 0.0);
      EXPECT_EQ(m(2, 1), 0.0);
      EXPECT_GT(m.determinant(), 0.0);
    }
  }
}

TEST(IsotropicFamily, AMirroredStartIsTurnedUpright) {
  Matrix3d m;
  m << -0.3, 0, -0.8, 0, 0.2, 0, -0.15, 0, 0.7;  // det < 0: a flip of x of the general start above
  const IsotropicParametrization p(IsotropicFamily::kPlane4, false, kMean, m);
  const Matrix3d upright = m * Vector3d(-1, 1, 1).asDiagonal();
  EXPECT_LT((scaledLike(p.matrix(p.start()), upright) - upright).norm(), 1e-12);
}

TEST(IsotropicFamily, StepsAreRelativeToTheLobe) {
  // the same step turns a lobe of alpha 1e-4 by as much of its own width as one of alpha 0.3
  for (double aperture : {0.3, 1e-4}) {
    const Matrix3d m = frameAbout(kMean) * Vector3d(aperture, aperture, 1.0).asDiagonal();
    const IsotropicParametrization p(IsotropicFamily::kPlane4, false, kMean, m);
    std::vector<double> v = p.start();
    v[3] += 0.1;
    const double turned =
        std::acos(std::min(1.0, p.matrix(v).col(2).normalized().dot(m.col(2).normalized())));
    EXPECT_NEAR(turned / aperture, 0.1, 1e-3);
  }
}

TEST(IsotropicFamily, FrameIsARotationOntoTheDirection) {
  const Matrix3d f = frameAbout(kMean);
  EXPECT_LT((f * f.transpose() - Matrix3d::Identity()).norm(), 1e-15);
  EXPECT_NEAR(f.determinant(), 1.0, 1e-15);
  EXPECT_LT((f.col(2) - kMean.normalized()).norm(), 1e-15);
}

}  // namespace
}  // namespace ltcfit
