#include "ltc/alignment.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "ggx/random.h"
#include "ltc/ltc.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d rotationZ(double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
}

Matrix3d randomLobe(Random& random, double aperture) {
  Matrix3d m = Matrix3d::Identity();
  for (int k = 0; k < 9; ++k) m(k / 3, k % 3) += 0.3 * random.normal();
  m.leftCols<2>() *= aperture;
  if (m.determinant() < 0.0) m.col(1) *= -1.0;
  return m;
}

// Mean squared distance of eq. 12, by random samples.
double distance(const Matrix3d& m) {
  const R2Sequence points(3);
  double sum = 0.0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const Vector3d x = sampleCosine(points(static_cast<std::uint64_t>(i)));
    sum += ((m * x).normalized() - x).squaredNorm() / n;
  }
  return sum;
}

TEST(Alignment, FindsWhatASearchOverAnglesFinds) {
  Random random(1);
  for (const double aperture : {1.0, 0.3, 0.01, 1e-4}) {
    const Matrix3d m = randomLobe(random, aperture) * rotationZ(6.0 * random.uniform());
    const Alignment a = align(m);
    double best = 1e9;
    for (int k = 0; k < 360; ++k)
      best = std::min(best, distance(m * rotationZ(k * std::numbers::pi / 180.0)));
    EXPECT_LE(distance(a.m), best + 1e-4 * aperture) << aperture;
    EXPECT_NEAR(a.distanceAfter, distance(a.m), 2e-3);
    EXPECT_NEAR(a.distanceBefore, distance(m), 2e-3);
    EXPECT_LE(a.distanceAfter, a.distanceBefore + 1e-15);
    EXPECT_NEAR((m * rotationZ(a.angle) - a.m).norm(), 0.0, 1e-12);
  }
}

TEST(Alignment, UndoesARotationOfTheSamples) {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    const Matrix3d aligned = align(randomLobe(random, 0.5)).m;
    const Alignment again = align(aligned * rotationZ(0.7 + i));
    // the quadrature has sectors, not all angles
    EXPECT_LT((again.m - aligned).norm(), 2e-3) << i;
    EXPECT_NEAR(align(aligned).angle, 0.0, 1e-3);
  }
}

TEST(Alignment, KeepsTheLobeAndTheSignOfTheDeterminant) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    Matrix3d m = randomLobe(random, 0.4);
    if (i % 2 == 1) m.col(0) *= -1.0;
    const Alignment a = align(m);
    EXPECT_NEAR(a.m.determinant(), m.determinant(), 1e-12);
    const Vector3d w = Vector3d(random.normal(), random.normal(), 1.0).normalized();
    EXPECT_NEAR(Ltc(a.m).density(w), Ltc(m).density(w), 1e-10 * (1.0 + Ltc(m).density(w)));
    EXPECT_EQ(a.flipWouldBeCloser, i % 2 == 1) << "a mirrored matrix is nearer to the samples mirrored back";
  }
}

TEST(Alignment, LeavesSymmetricMatricesAsTheyAre) {
  Matrix3d m;
  m << 0.4, 0, -0.5, 0, 0.2, 0, 0.1, 0, 0.9;
  const Alignment a = align(m);
  EXPECT_NEAR((a.m - m).norm(), 0.0, 1e-15);
  EXPECT_GT(a.strength, 0.7);
  EXPECT_NEAR(align(Matrix3d::Identity()).strength, 1.0, 1e-12);
}

TEST(Alignment, SaysWhereTheAngleIsNotDetermined) {
  // mirrored in one axis: the two pull against each other and every angle is equally good
  const Alignment a = align(Vector3d(0.5, -0.5, 1.0).asDiagonal());
  EXPECT_LT(a.strength, 1e-10);
  EXPECT_TRUE(a.m.allFinite());
}

}  // namespace
}  // namespace ltcfit
