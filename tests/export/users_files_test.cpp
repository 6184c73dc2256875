// Files as users have them: names of their own, a second texture beside, other number types, numbers missing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "export/atomic_file.h"
#include "export/dds.h"
#include "export/json_table.h"
#include "export/ktx2.h"
#include "export/npy.h"
#include "export/published_table.h"
#include "export/read_table.h"
#include "export/texture_files.h"
#include "tests/support/small_table.h"
#include "tests/support/texture_2017.h"

namespace ltcfit {
namespace {

class UsersFiles : public testing::Test {
 protected:
  UsersFiles() : textures_(test::textures2017()) {
    char name[] = "/tmp/ltcfit-users-XXXXXX";
    folder_ = ::mkdtemp(name);
  }
  ~UsersFiles() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& bytes) {
    writeFileAtomically(folder_ / name, bytes);
    return folder_ / name;
  }
  static std::string npy(const Image& image) {
    return arrayToNpy({{image.height, image.width, image.components}, image.values}, Precision::kFloat);
  }
  std::string text(const std::string& name, std::size_t texture) {
    return fmt::format("var {} = [{:.9g}];", name, fmt::join(textures_[texture].values, ","));
  }
  std::vector<float> expected() { return tableFrom2017(textures_[0], &textures_[1], "T").data(); }
  static std::string messageOf(const std::string& path, const ReadOptions& options = {}) {
    try {
      readTable(path, options);
      return "read";
    } catch (const InputError& error) {
      return error.what();
    }
  }
  static void expectPart(const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }

  std::filesystem::path folder_;
  std::vector<Image> textures_;
};

TEST_F(UsersFiles, SecondTextureByItsName) {
  for (const auto& [first, second] :
       std::initializer_list<std::pair<std::string, std::string>>{{"ltc_mat", "ltc_amp"},
                                                                  {"ltc_mat", "ltc_mag"},
                                                                  {"LtcMat", "LtcAmp"},
                                                                  {"LTC_MAT", "LTC_AMP"},
                                                                  {"ltc_matrix", "ltc_amplitude"},
                                                                  {"T_LtcMatrix_GGX", "T_LtcMagnitude_GGX"},
                                                                  {"ltc_1", "ltc_2"},
                                                                  {"LUT1", "LUT2"},
                                                                  {"ltc2017-1", "ltc2017-2"},
                                                                  {"ltc1_ggx", "ltc2_ggx"}}) {
    const std::string path = write(first + ".npy", npy(textures_[0]));
    EXPECT_EQ(readTableFile(path).notes, std::vector<std::string>()) << first;
    const std::string beside = write(second + ".npy", npy(textures_[1]));
    const TableFile file = readTableFile(path);
    EXPECT_EQ(file.table.data(), expected()) << first;
    EXPECT_EQ(file.notes, std::vector<std::string>{path + ": norm and Fresnel are taken from " + beside});
    EXPECT_EQ(filesOfTable(path), (std::vector<std::string>{path, beside}));
    std::filesystem::remove(path);
    std::filesystem::remove(beside);
  }
}

TEST_F(UsersFiles, SecondTextureByOption) {
  const std::string path = write("a.npy", npy(textures_[0]));
  EXPECT_EQ(readTable(path).data().size(), 64u * 5u);
  Image two = textures_[1];
  two.components = 2;
  two.values.clear();
  for (std::size_t i = 0; i < textures_[1].values.size(); i += 4)
    two.values.insert(two.values.end(), {textures_[1].values[i], textures_[1].values[i + 1]});
  for (const std::string& second :
       {write("b.npy", npy(two)), write("b.dds", imageToDds(textures_[1], DdsHeader::kDx10)),
        write("b.ktx2", imageToKtx2({textures_[1], {}}, Ktx2Compression::kZstd)), write("b.js", text("x", 1)),
        write("b.json", fmt::format("{{\"x\": [{:.9g}]}}", fmt::join(two.values, ",")))}) {
    EXPECT_EQ(readTable(path, {second, {}}).data(), expected()) << second;
    EXPECT_EQ(filesOfTable(path, {second, {}}), (std::vector<std::string>{path, second}));
  }
  // of source code too, where the two arrays lie in two files
  const std::string source = write("first.js", text("g_ltc_1", 0));
  expectPart(messageOf(source), "g_ltc_1 without the array of norm and Fresnel");
  EXPECT_EQ(readTable(source, {folder_ / "b.js", {}}).data(), expected());
}

TEST_F(UsersFiles, SecondTextureThatDoesNotFit) {
  const std::string path = write("a.npy", npy(textures_[0]));
  Image half = textures_[1];
  half.height = 4;
  half.values.resize(8 * 4 * 4);
  expectPart(messageOf(path, {write("half.npy", npy(half)), {}}),
             "the second texture, 8 x 4 x 1, 4 components, 1 layers, does not go with the first, 8 x 8 x 1");
  expectPart(messageOf(path, {write("half.js", "x = [1, 2, 3];"), {}}),
             "half.js: no array of 2 to 4 numbers for each of 8 x 8 texels; found: x (3 numbers)");
  expectPart(messageOf(path, {folder_ / "none.npy", {}}), "none.npy");
  expectPart(messageOf(path, {write("empty.npy", ""), {}}), "empty.npy");
  const std::string both = write("both.js", text("LTC_1", 0) + text("LTC_2", 1));
  EXPECT_EQ(readTable(both).data(), expected());
  expectPart(messageOf(both, {path, {}}), "has its norm and Fresnel");
  const std::string ours = write("ours.json", tableToJson(test::smallTable()));
  expectPart(messageOf(ours, {path, {}}), "--second");
}

TEST_F(UsersFiles, JsonObjectsOfArrays) {
  const auto list = [&](std::size_t t) {
    return fmt::format("[{:.9g}]", fmt::join(textures_[t].values, ","));
  };
  for (const char* const form :
       {R"({{"LTC_MAT_1": {}, "LTC_MAT_2": {}}})",
        "{{\n  \"name\": \"mine\",\n  \"ltc\": {{\"mat\": {}, \"amp\": {}}}\n}}\n"}) {
    const std::string json = fmt::format(fmt::runtime(form), list(0), list(1));
    EXPECT_EQ(readTable(write("a.json", json)).data(), expected()) << form;
    // JSON that lost its end is none, whatever it holds
    for (std::size_t n = 0; n + 1 < json.size(); n += 61)
      ASSERT_NE(messageOf(write("a.json", json.substr(0, n))), "read") << n;
  }
  expectPart(messageOf(write("b.json", R"({"x": [1, 2]})")), "arrays found: x (2 numbers)");
  expectPart(messageOf(write("b.json", R"({"axes": []})")), "format is missing");
}

TEST_F(UsersFiles, NumbersThatAreNoneAreToldByTheirTexel) {
  const std::size_t at = (7 * 8 + 3) * 4 + 2;
  std::vector<Image> bad = textures_;
  bad[0].values[at] = std::nanf("");
  const std::string place = "texel y 7, x 3, component 2";
  expectPart(messageOf(write("t_1.npy", npy(bad[0]))), "t_1.npy: " + place + " is not finite");
  expectPart(messageOf(write("a.dds", imageToDds(bad[0], DdsHeader::kLegacy))), "a.dds: " + place);
  expectPart(messageOf(write("a.ktx2", imageToKtx2({bad[0], {}}, Ktx2Compression::kNone))),
             "a.ktx2: " + place);
  Image layers = textures_[0];
  layers.layers = 2;
  layers.values.insert(layers.values.end(), bad[0].values.begin(), bad[0].values.end());
  expectPart(messageOf(write("l.ktx2", imageToKtx2({layers, {}}, Ktx2Compression::kNone))),
             "layer 1, " + place);
  bad[1].values[at] = INFINITY;
  const std::string second = write("b.npy", npy(bad[1]));
  expectPart(messageOf(write("a.npy", npy(textures_[0])), {second, {}}), "b.npy: " + place);
}

TEST_F(UsersFiles, NumbersThatAreNoneInOurOwnFiles) {
  for (const char* const format : {"npy", "dds", "ktx2", "exr", "bin"}) {
    PackedTable packed = pack(readTable(LTCFIT_DATA_DIR "/ltc_iso.json"), packing2017(), Precision::kFloat);
    packed.images[1].values[(5 * 64 + 9) * 4 + 1] = INFINITY;
    std::vector<ExportFile> files;
    if (format == std::string("npy")) files = toNpyFiles(packed, "a.npy");
    if (format == std::string("dds")) files = toDdsFiles(packed, DdsHeader::kDx10, "a.dds");
    if (format == std::string("ktx2")) files = toKtx2Files(packed, Ktx2Compression::kNone, "a.ktx2");
    if (format == std::string("exr")) files = toExrFiles(packed, "a.exr");
    if (format == std::string("bin")) files = toRawFiles(packed, "a.bin");
    for (const ExportFile& file : files) write(file.name, file.bytes);
    expectPart(messageOf(folder_ / files[0].name),
               files[0].name + ": texture 'amplitude': texel y 5, x 9, component 1 (fresnel) is not finite");
  }
  std::string json = tableToJson(test::smallTable());
  const std::size_t data = json.find("\"data\": [");
  const std::size_t third = json.find(",", json.find(",", data) + 1) + 1;
  json.replace(third, json.find(",", third) - third, " 1e39");
  expectPart(messageOf(write("t.json", json)),
             "data[2] = 1e+39 (theta[0], alpha[0], m11) does not fit a float32");
}

// A table of the 2022 layout with so many theta nodes: the identity, but for a mark at each node.
TEST_F(UsersFiles, AnyNumberOfThetaNodes) {
  for (std::size_t n = 2; n <= 64; ++n) {
    FloatArray array{{2, 2, n, 2, 3, 3}, {}};
    for (std::size_t i = 0; i < 8 * n; ++i) {
      array.values.insert(array.values.end(), {1, 0, 0, 0, 1, 0, 0, 0, 1});
      array.values[9 * i] = static_cast<float>(i + 1);
    }
    const std::string path = write("t.npy", arrayToNpy(array, Precision::kFloat));
    ASSERT_EQ(messageOf(path), "read") << n;
    const Table table = readTable(path);
    ASSERT_EQ(table.info().axes[2].size(), n);
    EXPECT_EQ(table.entry(std::vector<std::size_t>{1, 0, n - 1, 1}).m(0, 0), static_cast<double>(6 * n));
  }
}

}  // namespace
}  // namespace ltcfit
