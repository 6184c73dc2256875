#include "export/half_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>

#include "export/little_endian.h"
#include "export/packing.h"
#include "export/read_table.h"
#include "ltc/ltc.h"

namespace ltcfit {
namespace {

constexpr std::array<bool, 9> kPlane{true, false, true, false, false, false, true, false, true};
constexpr double kSmallestNormal = 6.103515625e-5;

double half(double v) {
  return static_cast<double>(halfValue(halfBits(static_cast<float>(v))));
}

Eigen::Matrix3d nearest(const Eigen::Matrix3d& m) {
  return m.unaryExpr([](double v) { return half(v); });
}

// The rounding's objective with other and more directions.
double shift(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  double sum = 0.0;
  constexpr int kCount = 500;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d x = sampleCosine({(i + 0.5) / kCount, std::fmod(i * std::numbers::sqrt2, 1.0)});
    sum += ((a * x).normalized() - (b * x).normalized()).norm();
  }
  return sum / kCount;
}

TEST(HalfBits, RoundsToNearestEven) {
  EXPECT_EQ(halfBits(1.0f), 0x3C00);
  EXPECT_EQ(halfBits(1.0f + 1.0f / 2048), 0x3C00);  // a tie
  EXPECT_EQ(halfBits(1.0f + 3.0f / 2048), 0x3C02);
  EXPECT_EQ(halfBits(65504.0f), 0x7BFF);
  EXPECT_EQ(halfBits(-6.103515625e-5f), 0x8400);
  for (std::uint32_t bits = 0; bits < 0x7C00; ++bits) {
    for (std::uint32_t sign : {0u, 0x8000u}) {
      const auto both = static_cast<std::uint16_t>(bits | sign);
      ASSERT_EQ(halfBits(halfValue(both)), both);
    }
  }
}

TEST(HalfMatrix, ExactMatricesStay) {
  Eigen::Matrix3d m;
  m << 0.5, 0, 0.25, 0, 1, 0, -0.125, 0, 2;
  const HalfRounding r = roundToHalf(m, MatrixStorage::kMinv, kPlane);
  EXPECT_EQ(r.matrix, m);
  EXPECT_EQ(r.shift, 0.0);
  EXPECT_EQ(r.detError, 0.0);
  EXPECT_FALSE(r.moved);
  EXPECT_FALSE(r.constrained);
}

TEST(HalfMatrix, BoundsHoldAndTheLobeIsCloserThanByNearestNumbers) {
  for (const char* kind : {"ltc_iso.json", "ltc_aniso.json"}) {
    const Table table = readTable(std::string(LTCFIT_DATA_DIR) + "/" + kind);
    const bool isotropic = table.isIsotropic();
    std::array<bool, 9> free = kPlane;
    if (!isotropic) free.fill(true);
    double ours = 0.0;
    double theirs = 0.0;
    for (std::size_t i = 0; i < table.nodeCount(); i += 3) {
      const TableEntry entry = table.entry(table.node(i));
      const MatrixStorage stores = isotropic ? MatrixStorage::kMinv : MatrixStorage::kM;
      const Eigen::Matrix3d m =
          isotropic ? Eigen::Matrix3d(entry.mInv / entry.mInv(1, 1)) : Eigen::Matrix3d(1024 * entry.m);
      const HalfRounding r = roundToHalf(m, stores, free);
      EXPECT_LE(std::abs(r.matrix.determinant() / m.determinant() - 1.0), 0.01) << i;
      for (int d = 0; d < 3; ++d) {
        EXPECT_GE(std::abs(r.matrix(d, d)), kSmallestNormal) << i;
        EXPECT_GT(r.matrix(d, d) * m(d, d), 0.0);
      }
      EXPECT_EQ(nearest(r.matrix), r.matrix) << "not halves at " << i;
      if (r.constrained) continue;
      const auto lobe = [&](const Eigen::Matrix3d& x) { return isotropic ? x.inverse().eval() : x; };
      ours += shift(lobe(r.matrix), lobe(m));
      theirs += shift(lobe(nearest(m)), lobe(m));
    }
    std::printf("%s: mean shift %.3f of that of nearest numbers\n", kind, ours / theirs);
    EXPECT_LT(ours, 0.95 * theirs) << kind;
  }
}

// The neighbourhood of the nearest halves breaks the bounds there: the smallest alphas at 90 degrees.
TEST(HalfMatrix, OutOfReachOfTheNearestHalves) {
  const Table table = readTable(LTCFIT_DATA_DIR "/ltc_iso.json");
  for (std::size_t a : {0u, 1u, 2u}) {
    const Eigen::Matrix3d mInv = table.entry(std::vector<std::size_t>{63, a}).mInv;
    const Eigen::Matrix3d m = mInv / mInv(1, 1);
    EXPECT_LT(nearest(m).diagonal().cwiseAbs().minCoeff(), kSmallestNormal);
    const HalfRounding r = roundToHalf(m, MatrixStorage::kMinv, kPlane);
    EXPECT_TRUE(r.constrained);
    EXPECT_LE(r.detError, kHalfDeterminantLimit);
    // a quarter of a degree; at grazing view only, on lobes narrower than that
    EXPECT_LT(r.shift, 5e-3);
    EXPECT_LT(shift(r.matrix.inverse(), mInv.inverse()), 6e-3);
  }
}

TEST(HalfMatrix, WhatNoHalfCanHoldIsRefused) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m(0, 0) = 1e-9;
  EXPECT_THROW(
      roundToHalf(m, MatrixStorage::kMinv, {true, false, false, false, false, false, false, false, true}),
      std::invalid_argument);
}

// What users report of the half table of 2017: lost determinants, zeros and subnormals. Ours of the same
// table.
TEST(HalfMatrix, ThePublishedTableMadeSafe) {
  const std::filesystem::path folder(LTCFIT_REFERENCE_DIR);
  if (!std::filesystem::exists(folder / "ltc2017-1.npy"))
    GTEST_SKIP() << "the published tables are not at " << folder << " (LTCFIT_REFERENCE_DIR)";
  const Table exact = readTable(folder / "ltc2017-1.npy");
  const Table theirs = readTable(folder / "ltc2017-1.dds");
  const Table ours = unpack(pack(exact, packing2017(), Precision::kHalf));
  const auto faults = [&](const Table& table, double floor) {
    int count = 0;
    for (std::size_t i = 0; i < table.nodeCount(); ++i) {
      const auto node = table.node(i);
      if (table.parameters(node).alphaX < floor) continue;
      const Eigen::Matrix3d m = table.entry(node).mInv;
      const double error = std::abs(m.determinant() / exact.entry(node).mInv.determinant() - 1.0);
      const bool fault = !(error <= 0.01) || m.diagonal().cwiseAbs().minCoeff() < kSmallestNormal;
      count += fault ? 1 : 0;
    }
    return count;
  };
  std::printf("faults: theirs %d, ours %d\n", faults(theirs, 0.0), faults(ours, 0.0));
  EXPECT_GT(faults(theirs, 0.0), 20);
  EXPECT_EQ(faults(ours, 0.0), 0);
}

}  // namespace
}  // namespace ltcfit
