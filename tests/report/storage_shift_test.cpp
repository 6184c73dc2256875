#include "report/storage_shift.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d tilted(const Matrix3d& m, double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix() * m;
}

TEST(StorageShift, OfATurnedNeedleIsTheAngle) {
  const Matrix3d needle = Vector3d(1e-4, 1e-4, 1.0).asDiagonal();
  // turned about y: directions next to z move by the chord; the needle's own width changes that by its square
  EXPECT_NEAR(lobeShift(needle, tilted(needle, 0.02)), 2.0 * std::sin(0.01), 1e-6);
  EXPECT_EQ(lobeShift(needle, needle), 0.0);
  EXPECT_NEAR(lobeShift(needle, 7.0 * needle), 0.0, 1e-15) << "scale";
}

TEST(StorageShift, Float32IsExactForPowersOfTwoAndLostForNeedlesThatLean) {
  EXPECT_EQ(float32Shift(Vector3d(0.25, 0.5, 1.0).asDiagonal()), 0.0);
  // columns 0 and 2 agree to 1e-9, which float32 does not hold: singular
  Matrix3d m;
  m << 1.0, 0.0, 1.0, 0.0, 1e-6, 0.0, 1.0, 0.0, 1.0 + 1e-9;
  EXPECT_FALSE(float32Shift(m) <= 0.1);
}

TEST(StorageShift, HalvesKeepWhatTheyHoldAndNoMore) {
  EXPECT_EQ(halfShift(Vector3d(0.25, 0.5, 1.0).asDiagonal(), TableKind::kIsotropic), 0.0);
  const Matrix3d rough = tilted(Vector3d(0.3, 0.4, 1.0).asDiagonal(), -0.7);
  for (const TableKind kind : {TableKind::kIsotropic, TableKind::kAnisotropic}) {
    EXPECT_GT(halfShift(rough, kind), 1e-6);
    EXPECT_LT(halfShift(rough, kind), 1e-3);  // half's step is 5e-4 of an entry at most
  }
  // a needle next to the horizon, 0.01 long, moves by half its length
  EXPECT_GT(halfShift(tilted(Vector3d(1e-2, 1e-4, 1.0).asDiagonal(), -1.57), TableKind::kIsotropic), 4e-3);
}

}  // namespace
}  // namespace ltcfit
