// What lies in a file is what the sampler gets.
#include "render/shader_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "export/atomic_file.h"
#include "export/formats.h"
#include "export/json_table.h"
#include "export/read_table.h"
#include "tests/support/tailored.h"

namespace ltcfit::test {
namespace {

class ShaderTableTest : public testing::Test {
 protected:
  ShaderTableTest() {
    std::string name = (std::filesystem::temp_directory_path() / "ltcfit-shader-table-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) ADD_FAILURE() << "no folder " << name;
    folder_ = name;
  }
  ~ShaderTableTest() override { std::filesystem::remove_all(folder_); }

  // The path of the first file of an export, all of which are written.
  std::string write(const Table& table, const char* format, const FormatOptions& options) {
    const std::string name = std::string("t") + std::string(findFormat(format)->extension);
    const ExportResult result = exportTable(table, *findFormat(format), options, name);
    for (const ExportFile& file : result.files) writeFileAtomically(path(file.name), file.bytes);
    return path(result.files[0].name);
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_;
};

Table dataTable(bool isotropic) {
  return readTable(std::string(LTCFIT_DATA_DIR) + (isotropic ? "/ltc_iso.json" : "/ltc_aniso.json"));
}

PackedTable packedFor(const Table& table, Precision precision) {
  return pack(table, table.isIsotropic() ? packing2017() : packingOfRows(), precision);
}

void expectTexels(const ShaderTable& is, const PackedTable& should) {
  std::vector<float> values;
  for (const Image& image : should.images)
    values.insert(values.end(), image.values.begin(), image.values.end());
  std::vector<float> read;
  for (const Image& image : is.textures) {
    EXPECT_EQ(image.precision, should.precision);
    EXPECT_EQ(image.layers, 1u);
    read.insert(read.end(), image.values.begin(), image.values.end());
  }
  EXPECT_EQ(read, values);
  EXPECT_EQ(is.table.data(), unpack(should).data());
  EXPECT_EQ(is.table.info().channels, unpack(should).info().channels);
  if (is.isIsotropic()) {
    ASSERT_EQ(is.textures.size(), 2u);
    EXPECT_EQ(is.textures[0].width, is.table.info().axes[1].size());
    EXPECT_EQ(is.textures[0].height, is.table.info().axes[0].size());
  } else {
    ASSERT_EQ(is.textures.size(), 1u);
    EXPECT_EQ(is.textures[0].depth, 3 * is.nodes()[0] * is.nodes()[1]);
  }
}

TEST_F(ShaderTableTest, TexturesAreReadTexelForTexel) {
  for (bool isotropic : {true, false}) {
    const Table table = dataTable(isotropic);
    for (Precision precision : {Precision::kFloat, Precision::kHalf}) {
      const PackedTable packed = packedFor(table, precision);
      FormatOptions options;
      options.precision = precision;
      for (const char* format : {"ktx2", "dds", "exr", "npy"}) {
        SCOPED_TRACE(std::string(format) + (isotropic ? " isotropic" : " anisotropic"));
        options.layout = Layout::kPacked;
        const ShaderTable is = loadShaderTable(write(table, format, options));
        expectTexels(is, packed);
        EXPECT_EQ(is.note.rfind("read texel for texel from ", 0), 0u) << is.note;
        EXPECT_EQ(is.note.find("half") != std::string::npos, precision == Precision::kHalf) << is.note;
      }
    }
  }
}

TEST_F(ShaderTableTest, TheLayoutOf2017NeedsNoDescription) {
  const Table table = dataTable(true);
  FormatOptions options;
  options.precision = Precision::kHalf;
  options.ddsHeader = DdsHeader::kLegacy;
  const std::string file = write(table, "dds", options);
  const PackedTable packed = packedFor(table, Precision::kHalf);
  expectTexels(loadShaderTable(file), packed);
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    if (entry.path().extension() == ".json") std::filesystem::remove(entry.path());
  }
  const ShaderTable plain = loadShaderTable(file);
  expectTexels(plain, packed);
  EXPECT_EQ(plain.note, "read texel for texel from DDS, half");

  // without its second texture it has nothing to shade with
  std::filesystem::remove(path("t-2.dds"));
  EXPECT_THROW(loadShaderTable(file), InputError);
  const ShaderTable mended = loadShaderTable(file, &table);
  EXPECT_EQ(mended.textures[0].values, packed.images[0].values);
  EXPECT_NE(mended.note.find("norm and fresnel of another table"), std::string::npos);
}

TEST_F(ShaderTableTest, EverythingElseIsPackedInFloat) {
  for (bool isotropic : {true, false}) {
    const Table table = dataTable(isotropic);
    const PackedTable packed = packedFor(table, Precision::kFloat);
    for (const char* format : {"json", "h", "ktx2"}) {
      SCOPED_TRACE(format);
      FormatOptions options;
      if (std::string(format) == "ktx2") options.layout = Layout::kChannels;
      const std::string file = std::string(format) == "json" ? path("t.json") : write(table, format, options);
      if (std::string(format) == "json") writeFileAtomically(file, tableToJson(table));
      const ShaderTable is = loadShaderTable(file);
      expectTexels(is, packed);
      EXPECT_EQ(is.note.rfind("converted from ", 0), 0u) << is.note;
    }
  }
}

Table without(const Table& table, const std::string& channel) {
  TableInfo info = table.info();
  const auto at = std::find(info.channels.begin(), info.channels.end(), channel) - info.channels.begin();
  info.channels.erase(info.channels.begin() + at);
  std::vector<float> data;
  for (std::size_t i = 0; i < table.data().size(); ++i) {
    if (i % table.channelCount() != static_cast<std::size_t>(at)) data.push_back(table.data()[i]);
  }
  return Table(std::move(info), std::move(data));
}

TEST_F(ShaderTableTest, AmplitudesComeFromAnotherTable) {
  const Table table = dataTable(false);
  const std::string file = path("t.json");
  writeFileAtomically(file, tableToJson(without(without(table, "norm"), "fresnel")));
  EXPECT_THROW(loadShaderTable(file), InputError);
  const Table isotropic = dataTable(true);
  EXPECT_THROW(loadShaderTable(file, &isotropic), InputError);
  const Table half = without(table, "fresnel");
  EXPECT_FALSE(loadShaderTable(file, &half).hasFresnel());
  const ShaderTable is = loadShaderTable(file, &table);
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    const TableEntry read = is.table.entry(table.node(i));
    const TableEntry should = table.entry(table.node(i));
    EXPECT_EQ(read.m, should.m);
    // rounding of the angles; at alpha = 0 every lambda is the same place, and the tables differ among them
    if (i < table.nodeCount() / 8) continue;
    EXPECT_NEAR(*read.norm, *should.norm, 1e-7);
    EXPECT_NEAR(*read.fresnel, *should.fresnel, 1e-7);
  }
}

TEST_F(ShaderTableTest, OtherAxesHaveALookUpOfTheirOwn) {
  for (const Tailored& t : tailoredTables()) {
    const std::string file = path("t.json");
    writeFileAtomically(file, tableToJson(t.table));
    const std::vector<std::string> amplitudes = amplitudesOf(t.table.info());
    if (amplitudes.empty() || amplitudes[0] != "norm") {
      EXPECT_THROW(loadShaderTable(file), InputError) << t.name;
      continue;
    }
    const ShaderTable is = loadShaderTable(file);
    EXPECT_EQ(is.lookup.has_value(), t.name != "isoFull" && t.name != "anisoFull") << t.name;
    EXPECT_EQ(is.hasFresnel(), amplitudes.size() == 2) << t.name;
    EXPECT_EQ(is.table.data(), t.table.data()) << t.name;
    if (!is.lookup) continue;
    // the best axes reach over the whole domain
    EXPECT_EQ(is.note.find("the nearest end for other lobes") != std::string::npos, t.name != "anisoBest")
        << t.name << ": " << is.note;
    FormatOptions options;
    options.layout = Layout::kLean;
    options.precision = Precision::kHalf;
    const ShaderTable half = loadShaderTable(write(t.table, "dds", options));
    EXPECT_EQ(half.note.rfind("read texel for texel from DDS, half", 0), 0u) << half.note;
  }
}

TEST_F(ShaderTableTest, AxesThatAShaderWouldSearchAreRefused) {
  const Table table = dataTable(true);
  for (std::size_t a : {0, 1}) {
    TableInfo info = table.info();
    info.axes[a].map = AxisMap::kNone;
    const std::string file = path("t.json");
    writeFileAtomically(file, tableToJson(Table(info, table.data())));
    EXPECT_THROW(loadShaderTable(file), InputError) << a;
  }
}

}  // namespace
}  // namespace ltcfit::test
