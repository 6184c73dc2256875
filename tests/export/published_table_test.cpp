#include "export/published_table.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "export/atomic_file.h"
#include "export/read_table.h"

namespace ltcfit {
namespace {

// A texture of 3 x 2 texels.
Image image() {
  Image out;
  out.width = 3;
  out.height = 2;
  for (int i = 0; i < 24; ++i)
    out.values.push_back((i % 4 == 1 ? -0.25f : i % 4 == 2 ? 0.125f : 0.5f) + 0.001f * static_cast<float>(i));
  return out;
}

TEST(PublishedTable, MeaningOfThe2017Layout) {
  const Image first = image();
  Image second = first;
  for (std::size_t i = 0; i < second.values.size(); i += 4) {
    second.values[i + 1] = 0.25f;
    second.values[i + 2] = 0.0f;
  }
  const Table table = tableFrom2017(first, &second, "a");
  const TableEntry e = table.entry(std::vector<std::size_t>{1, 2});
  const std::size_t texel = (1 * 3 + 2) * 4;
  EXPECT_FLOAT_EQ(static_cast<float>(e.mInv(0, 0)), first.values[texel]);
  EXPECT_FLOAT_EQ(static_cast<float>(e.mInv(2, 0)), first.values[texel + 1]);
  EXPECT_FLOAT_EQ(static_cast<float>(e.mInv(0, 2)), first.values[texel + 2]);
  EXPECT_FLOAT_EQ(static_cast<float>(e.mInv(2, 2)), first.values[texel + 3]);
  EXPECT_EQ(e.mInv(1, 1), 1.0);
  EXPECT_FLOAT_EQ(static_cast<float>(*e.norm), first.values[texel]);
  EXPECT_EQ(table.parameters(std::vector<std::size_t>{1, 0}).theta, 1.57);
  EXPECT_EQ(table.parameters(std::vector<std::size_t>{1, 0}).alphaX, 1e-5);
}

// Other layouts in textures of the same size must not pass for it: O3DE's, Godot's, swapped or doubled
// textures.
TEST(PublishedTable, OtherLayoutsAreRefused) {
  const Image first = image();
  EXPECT_NO_THROW(tableFrom2017(first, nullptr, "a"));
  EXPECT_THROW(tableFrom2017(first, &first, "a"), InputError);
  Image turned = first;
  for (std::size_t i = 0; i < turned.values.size(); i += 4)
    std::swap(turned.values[i + 1], turned.values[i + 3]);
  EXPECT_THROW(tableFrom2017(turned, nullptr, "a"), InputError);
  Image mirrored = first;
  for (std::size_t i = 0; i < mirrored.values.size(); i += 4) mirrored.values[i + 3] *= -1.0f;
  EXPECT_THROW(tableFrom2017(mirrored, nullptr, "a"), InputError);
}

TEST(PublishedTable, SecondTextureAloneIsTold) {
  Image second = image();
  for (std::size_t i = 2; i < second.values.size(); i += 4) second.values[i] = 0.0f;
  EXPECT_THROW(tableFrom2017(second, nullptr, "a"), InputError);
}

TEST(PublishedTable, TheRealOnes) {
  const std::filesystem::path folder(LTCFIT_REFERENCE_DIR);
  if (!std::filesystem::exists(folder / "ltc2017-1.npy")) {
    GTEST_SKIP() << "the published tables are not at " << folder << " (LTCFIT_REFERENCE_DIR)";
  }
  const Table npyTable = readTable(folder / "ltc2017-1.npy");
  const Table ddsTable = readTable(folder / "ltc2017-1.dds");
  EXPECT_EQ(npyTable.nodeCount(), 4096u);
  // alpha 1, normal view: nearly the cosine
  const TableEntry e = npyTable.entry(std::vector<std::size_t>{0, 63});
  EXPECT_NEAR(e.mInv(0, 0), 1.0, 1e-3);
  EXPECT_NEAR(*e.norm, 0.307, 1e-2);
  // half is float rounded
  for (std::size_t i = 0; i < npyTable.data().size(); ++i) {
    EXPECT_NEAR(ddsTable.data()[i], npyTable.data()[i], 1e-3f * std::abs(npyTable.data()[i]) + 1e-7f);
  }
  const Table aniso = readTable(folder / "kt2022-alpha-lambda-theta-phi.npy");
  EXPECT_EQ(aniso.nodeCount(), 4096u);
  EXPECT_FALSE(aniso.isIsotropic());
  EXPECT_NEAR(aniso.entry(std::vector<std::size_t>{4, 4, 4, 4}).m.col(2).norm(), 1.0, 1e-5);
}

}  // namespace
}  // namespace ltcfit
