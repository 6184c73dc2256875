#include "export/packing.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "export/atomic_file.h"
#include "export/dds.h"
#include "export/little_endian.h"
#include "export/npy.h"
#include "export/read_table.h"
#include "ltc/sphere.h"
#include "tests/support/small_table.h"

namespace ltcfit {
namespace {

TEST(Packing, LayoutOf2017) {
  const Table table = test::smallTable();
  const PackedTable packed = pack(table, packing2017(), Precision::kFloat);
  ASSERT_EQ(packed.images.size(), 2u);
  EXPECT_EQ(packed.images[0].width, 4u);   // alpha
  EXPECT_EQ(packed.images[0].height, 3u);  // theta
  const std::size_t texel = 1 * 4 + 2;
  const TableEntry e = table.entry(std::vector<std::size_t>{1, 2});
  const float* const t1 = packed.images[0].values.data() + 4 * texel;
  const float* const t2 = packed.images[1].values.data() + 4 * texel;
  EXPECT_EQ(t1[0], static_cast<float>(e.mInv(0, 0) / e.mInv(1, 1)));
  EXPECT_EQ(t1[1], static_cast<float>(e.mInv(2, 0) / e.mInv(1, 1)));
  EXPECT_EQ(t1[2], static_cast<float>(e.mInv(0, 2) / e.mInv(1, 1)));
  EXPECT_EQ(t1[3], static_cast<float>(e.mInv(2, 2) / e.mInv(1, 1)));
  EXPECT_EQ(t2[0], static_cast<float>(*e.norm));
  EXPECT_EQ(t2[1], static_cast<float>(*e.fresnel));
  EXPECT_EQ(t2[2], 0.0f);
  // x = cos from -1 to 1, y = length
  EXPECT_EQ(t2[3], static_cast<float>(sphereTableValue(2.0 * 2 / 3 - 1.0, 0.5)));
}

TEST(Packing, UnpackIsItsInverse) {
  for (const Table& table : {test::smallTable(), readTable(LTCFIT_DATA_DIR "/ltc_aniso.json")}) {
    for (std::size_t perTexture : {std::size_t{4}, table.channelCount()}) {
      const Table back = unpack(pack(table, packingOfChannels(table.info(), perTexture), Precision::kFloat));
      EXPECT_EQ(back.data(), table.data());
      EXPECT_EQ(back.info().channels, table.info().channels);
      EXPECT_EQ(back.info().normalization, table.info().normalization);
    }
    // what was rounded once stays
    const Packing packing = table.isIsotropic() ? packing2017() : packingOfRows();
    for (Precision precision : {Precision::kFloat, Precision::kHalf}) {
      const Table once = unpack(pack(table, packing, precision));
      const PackedTable again = pack(once, packing, precision);
      EXPECT_EQ(unpack(again).data(), once.data());
      EXPECT_EQ(again.half.constrained, 0u);
    }
  }
}

// The scale of a node weighs it in look-ups: divided by the third column's length, a refined table would be
// another one between its nodes.
TEST(Packing, ScalesOfARefinedTableAreKept) {
  const Table table = readTable(LTCFIT_DATA_DIR "/ltc_aniso_refined.json");
  ASSERT_EQ(table.info().normalization, MatrixNormalization::kNone);
  const Table back = unpack(pack(table, packingOfRows(), Precision::kFloat));
  EXPECT_EQ(back.info().normalization, MatrixNormalization::kNone);
  EXPECT_EQ(back.data(), table.data());
  // and the scales differ, so that this tells something
  EXPECT_GT(table.entry(table.node(2000)).m.col(2).norm() / table.entry(table.node(1)).m.col(2).norm(), 1.02);
}

TEST(Packing, HalvesAreHalves) {
  const Table table = readTable(LTCFIT_DATA_DIR "/ltc_aniso.json");
  const PackedTable packed = pack(table, packingOfRows(), Precision::kHalf);
  EXPECT_GT(packed.scale, 1.0);  // the smallest diagonal entry, 2.4e-7, is far below the normal halves
  EXPECT_EQ(std::exp2(std::round(std::log2(packed.scale))), packed.scale);
  for (const Image& image : packed.images) {
    for (float v : image.values) ASSERT_EQ(halfValue(halfBits(v)), v);
  }
  double worst = 0.0;
  const Table back = unpack(packed);
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    const auto node = table.node(i);
    const double det = back.entry(node).m.determinant() / table.entry(node).m.determinant();
    worst = std::max(worst, std::abs(det - 1.0));
    EXPECT_NEAR(*back.entry(node).norm, *table.entry(node).norm, 2.5e-4);  // half an ulp below 1
  }
  EXPECT_LE(worst, 0.01);
}

TEST(Packing, WhatHasNoPlaceIsRefused) {
  const Table aniso = readTable(LTCFIT_DATA_DIR "/ltc_aniso.json");
  EXPECT_THROW(pack(aniso, packing2017(), Precision::kFloat), std::invalid_argument);
  TableInfo info = test::smallTable().info();
  std::vector<float> data = test::smallTable().data();
  data[2] = 0.0f;
  const Table singular(info, data);
  EXPECT_THROW(pack(singular, packing2017(), Precision::kFloat), std::invalid_argument);
  EXPECT_NO_THROW(pack(test::smallTable(), packingOfRows(), Precision::kFloat));
}

TEST(Packing, ATableWithoutAmplitudesGetsZeros) {
  TableInfo info = test::smallTable().info();
  info.channels.resize(5);
  std::vector<float> data;
  for (std::size_t i = 0; i < test::smallTable().data().size(); ++i)
    if (i % 7 < 5) data.push_back(test::smallTable().data()[i]);
  const PackedTable packed = pack(Table(info, data), packing2017(), Precision::kFloat);
  EXPECT_EQ(packed.images[1].values[0], 0.0f);
  EXPECT_EQ(unpack(packed).info().channels.size(), 5u);
}

TEST(SphereTable, Limits) {
  EXPECT_EQ(sphereTableValue(1.0, 0.0), 1.0);
  EXPECT_EQ(sphereTableValue(-1.0, 0.0), 0.0);
  EXPECT_EQ(sphereTableValue(-1.0, 0.5), 0.0);
  EXPECT_NEAR(sphereTableValue(0.3, 1e-12), 0.3, 1e-6);
  // length 1: the half sphere about the direction; its visible part is a lune
  for (double z : {-0.9, -0.2, 0.0, 0.4, 1.0}) EXPECT_NEAR(sphereTableValue(z, 1.0), 0.5 * (1.0 + z), 1e-6);
}

TEST(SphereTable, IsThatOfThePublishedTexture) {
  const std::filesystem::path path = std::filesystem::path(LTCFIT_REFERENCE_DIR) / "ltc2017-2.npy";
  if (!std::filesystem::exists(path))
    GTEST_SKIP() << "the published tables are not at " << LTCFIT_REFERENCE_DIR;
  const FloatArray theirs = parseNpy(readFile(path), "a");
  double worst = 0.0;
  for (std::size_t y = 0; y < 64; ++y) {
    for (std::size_t x = 0; x < 64; ++x) {
      const double ours =
          sphereTableValue(2.0 * static_cast<double>(x) / 63 - 1.0, static_cast<double>(y) / 63);
      worst = std::max(worst, std::abs(ours - static_cast<double>(theirs.values[(y * 64 + x) * 4 + 3])));
    }
  }
  std::printf("largest difference %.3g\n", worst);
  EXPECT_LT(worst, 1e-3);
}

}  // namespace
}  // namespace ltcfit
