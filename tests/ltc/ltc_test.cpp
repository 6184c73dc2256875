#include "ltc/ltc.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "ggx/random.h"
#include "tests/support/chi_square.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

Matrix3d randomMatrix(Random& random) {
  Matrix3d m;
  do {
    for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = random.normal();
  } while (std::abs(m.determinant()) < 0.1);
  return m;
}

Vector3d randomDirection(Random& random) {
  return Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

TEST(Ltc, IdentityIsTheCosine) {
  Random random(1);
  const Ltc ltc(Matrix3d::Identity());
  for (int i = 0; i < 100; ++i) {
    const Vector3d w = randomDirection(random);
    EXPECT_NEAR(ltc.density(w), std::max(0.0, w.z()) / kPi, 1e-15);
  }
}

TEST(Ltc, IsInvariantUnderScaleRotationAboutZAndFlips) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const Matrix3d m = randomMatrix(random);
    const Matrix3d rotation = Eigen::AngleAxisd(6.0 * random.uniform(), Vector3d::UnitZ()).toRotationMatrix();
    const Matrix3d flipX = Vector3d(-1, 1, 1).asDiagonal();
    const Matrix3d flipY = Vector3d(1, -1, 1).asDiagonal();
    const Vector3d w = randomDirection(random);
    const double f = Ltc(m).density(w);
    for (const Matrix3d& same :
         {Matrix3d(3.7 * m), Matrix3d(m * rotation), Matrix3d(m * flipX), Matrix3d(m * flipY)}) {
      EXPECT_NEAR(Ltc(same).density(w), f, 1e-10 * (1.0 + f));
      EXPECT_NEAR(Ltc(same).massBelowHorizon(), Ltc(m).massBelowHorizon(), 1e-12);
    }
    // and a rotation that does matter is not absorbed
    const Matrix3d tilt = Eigen::AngleAxisd(0.5, Vector3d::UnitX()).toRotationMatrix();
    const Vector3d inside = Ltc(m).transform({0.3, 0.2, 0.9});
    EXPECT_GT(std::abs(Ltc(m * tilt).density(inside) - Ltc(m).density(inside)), 1e-6);
  }
}

TEST(Ltc, JacobiansAreInverseAndGiveTheDensity) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Ltc ltc(randomMatrix(random));
    const Vector3d x = sampleCosine({random.uniform(), random.uniform()});
    const Vector3d w = ltc.transform(x);
    EXPECT_NEAR(ltc.jacobian(x) * ltc.inverseJacobian(w), 1.0, 1e-10);
    EXPECT_NEAR(ltc.density(w) * ltc.jacobian(x), cosineDensity(x), 1e-10);
  }
}

TEST(Ltc, JacobianIsTheRatioOfSolidAngles) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const Ltc ltc(randomMatrix(random));
    const Vector3d x = sampleCosine({random.uniform(), random.uniform()});
    const double h = 1e-5;
    const Vector3d t1 = x.unitOrthogonal();
    const Vector3d t2 = x.cross(t1);
    const Vector3d d1 =
        (ltc.transform((x + h * t1).normalized()) - ltc.transform((x - h * t1).normalized())) / (2 * h);
    const Vector3d d2 =
        (ltc.transform((x + h * t2).normalized()) - ltc.transform((x - h * t2).normalized())) / (2 * h);
    EXPECT_NEAR(d1.cross(d2).norm() / ltc.jacobian(x), 1.0, 1e-6);  // h^2
  }
}

TEST(Ltc, SamplesHaveTheDensity) {
  // Bins of equal solid angle on the sphere, expected counts from the density by the midpoint rule.
  Random random(5);
  constexpr int kZ = 12, kPhi = 12, kFine = 40, kSamples = 100000, kMatrices = 6;
  for (int k = 0; k < kMatrices; ++k) {
    const Ltc ltc(randomMatrix(random));
    std::vector<double> observed(kZ * kPhi, 0.0), expected(kZ * kPhi, 0.0);
    for (int i = 0; i < kSamples; ++i) {
      const Vector3d w = ltc.sample({random.uniform(), random.uniform()});
      const int z = std::min(kZ - 1, static_cast<int>(0.5 * (w.z() + 1.0) * kZ));
      const int p = std::min(kPhi - 1, static_cast<int>((std::atan2(w.y(), w.x()) / (2 * kPi) + 0.5) * kPhi));
      observed[static_cast<std::size_t>(z * kPhi + p)] += 1.0;
    }
    for (int i = 0; i < kZ * kFine; ++i) {
      for (int j = 0; j < kPhi * kFine; ++j) {
        const double z = 2.0 * (i + 0.5) / (kZ * kFine) - 1.0;
        const double phi = 2.0 * kPi * ((j + 0.5) / (kPhi * kFine) - 0.5);
        const double r = std::sqrt(1.0 - z * z);
        const double area = 4.0 * kPi / (kZ * kFine * kPhi * kFine);
        expected[static_cast<std::size_t>((i / kFine) * kPhi + j / kFine)] +=
            kSamples * area * ltc.density({r * std::cos(phi), r * std::sin(phi), z});
      }
    }
    EXPECT_LT(test::chiSquareDeviations(observed, expected), test::sidakThreshold(kMatrices));
  }
}

// Largest deviation of a claimed gradient from central differences, relative to the gradient.
double gradientError(const Matrix3d& m, const Vector3d& w, const Matrix3d& claimed) {
  double worst = 0.0;
  for (int i = 0; i < 9; ++i) {
    const double h = 1e-6 * m.norm();
    Matrix3d up = m, down = m;
    up(i / 3, i % 3) += h;
    down(i / 3, i % 3) -= h;
    const double difference = (Ltc(up).density(w) - Ltc(down).density(w)) / (2.0 * h);
    worst = std::max(worst, std::abs(difference - claimed(i / 3, i % 3)));
  }
  return worst / claimed.norm();
}

TEST(Ltc, DensityGradientMatchesDifferences) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const Matrix3d m = randomMatrix(random);
    const Vector3d w = Ltc(m).sample({0.9 * random.uniform(), random.uniform()});  // off the support's edge
    const Matrix3d gradient = Ltc(m).densityGradient(w);
    EXPECT_LT(gradientError(m, w, gradient), 1e-6);
    // wrong ones are caught: transposed, and without the determinant's part
    EXPECT_GT(gradientError(m, w, gradient.transpose()), 1e-3);
    const Matrix3d noDeterminant = gradient + Ltc(m).density(w) * Ltc(m).mInv().transpose();
    EXPECT_GT(gradientError(m, w, noDeterminant), 1e-3);
  }
  EXPECT_EQ(Ltc(Matrix3d::Identity()).densityGradient({0, 0, -1}), Matrix3d::Zero());
}

TEST(Ltc, GradientOfASharpLobe) {
  const Matrix3d m = Vector3d(1e-4, 1e-4, 1.0).asDiagonal();
  const Vector3d w = Ltc(m).transform({0.4, -0.3, 0.8});
  // in the direction of the first column, whose scale is 1e-4
  const double h = 1e-9;
  Matrix3d up = m, down = m;
  up(0, 0) += h;
  down(0, 0) -= h;
  const double difference = (Ltc(up).density(w) - Ltc(down).density(w)) / (2.0 * h);
  EXPECT_NEAR(Ltc(m).densityGradient(w)(0, 0) / difference, 1.0, 1e-6);
}

TEST(Ltc, MassBelowTheHorizon) {
  EXPECT_EQ(Ltc(Matrix3d::Identity()).massBelowHorizon(), 0.0);
  const auto tilted = [](double angle) {
    return Ltc(Eigen::AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix()).massBelowHorizon();
  };
  EXPECT_NEAR(tilted(0.5 * kPi), 0.5, 1e-15);
  EXPECT_NEAR(tilted(kPi), 1.0, 1e-15);
  EXPECT_NEAR(tilted(0.3), 0.5 * (1.0 - std::cos(0.3)), 1e-15);
  Random random(7);
  for (int i = 0; i < 20; ++i) {
    const Ltc ltc(randomMatrix(random));
    const int n = 20000;
    int below = 0;
    for (int k = 0; k < n; ++k) below += ltc.sample({random.uniform(), random.uniform()}).z() < 0.0 ? 1 : 0;
    const double p = ltc.massBelowHorizon();
    EXPECT_NEAR(static_cast<double>(below) / n, p, 4.0 * std::sqrt(p * (1.0 - p) / n) + 1e-3);
  }
}

TEST(Ltc, FloatInvertibility) {
  EXPECT_TRUE(isInvertibleInFloat(Vector3d(1e-4, 1e-8, 1.0).asDiagonal()));
  EXPECT_FALSE(isInvertibleInFloat(Vector3d(1e-30, 1e-30, 1.0).asDiagonal()));  // det underflows
  EXPECT_FALSE(isInvertibleInFloat(Vector3d(1.0, 0.0, 1.0).asDiagonal()));
  EXPECT_FALSE(isInvertibleInFloat(Vector3d(1.0, std::nan(""), 1.0).asDiagonal()));
}

TEST(LtcDeathTest, RefusesASingularMatrix) {
  EXPECT_DEATH(Ltc(Vector3d(1.0, 0.0, 1.0).asDiagonal()), "singular matrix");
}

}  // namespace
}  // namespace ltcfit
