#include "export/published_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

#include "base/angles.h"
#include "export/atomic_file.h"
#include "export/layouts.h"
#include "export/profiles.h"
#include "export/read_table.h"
#include "export/reading_verdict.h"

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

// What is in files of engines without their description.
class UndescribedTable : public testing::Test {
 protected:
  UndescribedTable() {
    char name[] = "/tmp/ltcfit-layouts-XXXXXX";
    folder_ = ::mkdtemp(name);
  }
  ~UndescribedTable() override { std::filesystem::remove_all(folder_); }

  static const Table& iso() {
    static const Table table = readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_iso.json");
    return table;
  }
  // Writes the files of a profile but for the descriptions; the path of the first.
  std::string exported(const char* profile) {
    const ExportResult result =
        exportProfile(iso(), *findProfile(profile), true, std::string(findProfile(profile)->files[0]));
    std::string first;
    for (const ExportFile& file : result.files) {
      if (file.name.ends_with(".json")) continue;
      writeFileAtomically(folder_ / file.name, file.bytes);
      if (first.empty()) first = folder_ / file.name;
    }
    expected_ = unpack(pack(*result.table, findLayout(profile)->packing,
                            findProfile(profile)->half ? Precision::kHalf : Precision::kFloat));
    return first;
  }
  static std::string messageOf(const std::string& path, const ReadOptions& options) {
    try {
      readTable(path, options);
      return "read";
    } catch (const InputError& error) {
      return error.what();
    }
  }
  void expectSame(const Table& table) const {
    EXPECT_EQ(table.data(), expected_->data());
    EXPECT_EQ(table.info().channels, expected_->info().channels);
    EXPECT_EQ(table.info().stores, expected_->info().stores);
    for (std::size_t a = 0; a < 2; ++a) {
      EXPECT_EQ(table.info().axes[a].map, expected_->info().axes[a].map);
      EXPECT_EQ(table.info().axes[a].size(), expected_->info().axes[a].size());
    }
  }

  std::filesystem::path folder_;
  std::optional<Table> expected_;
};

TEST_F(UndescribedTable, FilesOfEnginesAreReadByTheirNumbers) {
  for (const char* const profile : {"godot", "o3de", "unity-hdrp"}) {
    const std::string path = exported(profile);
    const TableFile file = readTableFile(path);
    expectSame(file.table);
    const std::string note = fmt::format("{}: taken for the layout of {} by its numbers (misfits: 2017 ",
                                         path, findLayout(profile)->name);
    ASSERT_FALSE(file.notes.empty()) << profile;
    EXPECT_TRUE(file.notes.back().starts_with(note)) << file.notes.back();
    EXPECT_TRUE(judgeReading(file.table).passes()) << profile;
  }
}

TEST_F(UndescribedTable, LayoutsByName) {
  for (const char* const profile : {"godot", "o3de", "unity-hdrp"}) {
    const std::string path = exported(profile);
    for (const std::string_view name : {findLayout(profile)->name, std::string_view(profile)}) {
      const TableFile file = readTableFile(path, {"", std::string(name)});
      expectSame(file.table);
      for (const std::string& note : file.notes)
        EXPECT_EQ(note.find("by its numbers"), std::string::npos) << note;
    }
    // what is said counts, right or wrong
    const Table wrong = readTable(path, {"", "2017"});
    EXPECT_NE(wrong.data(), expected_->data());
    const ReadingVerdict verdict = judgeReading(wrong);
    EXPECT_FALSE(verdict.passes()) << profile;
  }
  const std::string path = exported("o3de");
  EXPECT_NE(messageOf(path, {"", "2018"}).find("layout '2018' is not one"), std::string::npos);
  EXPECT_NE(messageOf(path, {"", "2022"}).find("layout '2022' is not one"), std::string::npos);
  EXPECT_NE(messageOf(path, {"", "hdrp"}).find("the layout of hdrp has no second texture"),
            std::string::npos);
  const std::string lut = exported("godot");
  std::filesystem::remove(folder_ / "ltc_lut2.dds");
  EXPECT_NE(messageOf(lut, {"", "godot"}).find("has M22 in its second texture, and there is none"),
            std::string::npos);
  EXPECT_NE(messageOf(std::string(LTCFIT_DATA_DIR) + "/ltc_iso.ktx2", {"", "2017"})
                .find("layout '2017': " + std::string(LTCFIT_DATA_DIR) +
                      "/ltc_iso.ktx2 says itself what its numbers mean"),
            std::string::npos);
}

TEST_F(UndescribedTable, NumbersOfNoLayoutAreRefused) {
  Image noise = image();
  noise.width = noise.height = 8;
  noise.values.clear();
  for (int i = 0; i < 256; ++i) noise.values.push_back(static_cast<float>((i * 37) % 19) - 9.0f);
  const std::string path = folder_ / "noise.npy";
  writeFileAtomically(path, arrayToNpy({{8, 8, 4}, noise.values}, Precision::kFloat));
  const std::string message = messageOf(path, {});
  for (const char* const part :
       {"not the layout of 2017", "in none of the known ones do they make GGX lobes (misfits: 2017 ",
        ", 2016 ", ", hdrp "})
    EXPECT_NE(message.find(part), std::string::npos) << message;
}

// Every lobe of GGX at alpha_x and alpha_y of so many nodes, looked up in our table.
FloatArray arrayOfAlphas(std::size_t alphas, std::size_t thetas, std::size_t phis) {
  static const Table table = readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_aniso.json");
  FloatArray array{{alphas, alphas, thetas, phis, 3, 3}, {}};
  const auto at = [](std::size_t i, std::size_t n) {
    return static_cast<double>(i) / static_cast<double>(n - 1);
  };
  for (std::size_t i = 0; i < alphas; ++i)
    for (std::size_t j = 0; j < alphas; ++j)
      for (std::size_t k = 0; k < thetas; ++k)
        for (std::size_t l = 0; l < phis; ++l) {
          const Eigen::Matrix3d m = table
                                        .fetch({std::max(at(i, alphas), 1e-4), std::max(at(j, alphas), 1e-4),
                                                kHalfPi * at(k, thetas), kHalfPi * at(l, phis)})
                                        .m;
          for (int c = 0; c < 9; ++c) array.values.push_back(static_cast<float>(m(c / 3, c % 3)));
        }
  return array;
}

TEST_F(UndescribedTable, AxesAlphaXAndAlphaY) {
  for (const std::size_t n : {4u, 8u}) {
    const FloatArray array = arrayOfAlphas(n, 5, 4);
    const std::string path = folder_ / "alphas.npy";
    writeFileAtomically(path, arrayToNpy(array, Precision::kFloat));
    const TableFile file = readTableFile(path);
    ASSERT_EQ(file.notes.size(), 1u);
    EXPECT_TRUE(
        file.notes[0].starts_with(path + ": taken for a table with axes alpha_x, alpha_y, theta, phi"))
        << file.notes[0];
    EXPECT_EQ(readTable(path, {"", "alpha_x-alpha_y"}).data(), file.table.data());
    // at the largest alpha, lambda is alpha_y: the very matrices, up to their scale
    for (std::size_t j = 0; j < n; ++j) {
      const std::vector<std::size_t> node{n - 1, j, 2, 1};
      const std::size_t at = (((node[0] * n + node[1]) * 5 + node[2]) * 4 + node[3]) * 9;
      for (int c = 0; c < 9; ++c)
        EXPECT_EQ(static_cast<float>(file.table.entry(node).m(c / 3, c % 3)),
                  array.values[at + static_cast<std::size_t>(c)]);
    }
    // elsewhere they lie between: the means of the lobes are GGX's
    EXPECT_LT(misfitOf(file.table), n == 4 ? 0.06 : 0.02);
    const Table other = readTable(path, {"", "2022"});
    EXPECT_EQ(other.data(), array.values);
    EXPECT_GT(misfitOf(other), 0.06);
    EXPECT_FALSE(judgeReading(other).passes());
  }
}

TEST_F(UndescribedTable, ArraysOfAlphaAndLambdaStayWhatTheyAre) {
  const Table aniso = readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_aniso.json");
  std::vector<float> numbers;
  for (std::size_t i = 0; i < aniso.nodeCount(); ++i) {
    const Eigen::Matrix3d m = aniso.entry(aniso.node(i)).m;
    for (int c = 0; c < 9; ++c) numbers.push_back(static_cast<float>(m(c / 3, c % 3)));
  }
  std::vector<std::string> notes;
  EXPECT_EQ(tableFromArray({{8, 8, 8, 8, 3, 3}, numbers}, "", "T", notes).data(), numbers);
  // all lobes alike: nothing tells
  std::vector<float> same;
  for (int i = 0; i < 16; ++i) same.insert(same.end(), {1, 0, 0, 0, 1, 0, 0, 0, 1});
  EXPECT_EQ(tableFromArray({{2, 2, 2, 2, 3, 3}, same}, "", "T", notes).data(), same);
  EXPECT_EQ(notes, std::vector<std::string>{});
  EXPECT_THROW(tableFromArray({{2, 2, 2, 2, 3, 3}, same}, "2017", "T", notes), InputError);
  same.resize(9);
  EXPECT_THROW(tableFromArray({{1, 1, 1, 1, 3, 3}, same}, "alpha_x-alpha_y", "T", notes), InputError);
  EXPECT_THROW(tableFromArray({{1, 1, 3, 3}, same}, "", "T", notes), InputError);
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
