// Damaged files: every reader gives a table or an InputError, soon, and allocates no more than the file's
// length bears out.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "export/atomic_file.h"
#include "export/chebyshev_file.h"
#include "export/dds.h"
#include "export/exr.h"
#include "export/formats.h"
#include "export/json_table.h"
#include "export/ktx2.h"
#include "export/little_endian.h"
#include "export/npy.h"
#include "export/packing.h"
#include "export/read_table.h"
#include "export/source_table.h"
#include "export/text_arrays.h"
#include "export/texture_files.h"
#include "export/texture_metadata.h"
#include "ggx/random.h"
#include "tests/support/largest_allocation.h"
#include "tests/support/small_table.h"

namespace ltcfit {
namespace {

// What libraries allocate whatever the file is (zstd's and zlib's state, tables of OpenEXR, messages).
constexpr std::size_t kConstant = std::size_t{1} << 19;

struct Contents {
  std::string bytes;
  std::function<std::optional<Table>(std::string_view)> read;  // nothing: not a table
  std::size_t ratio;                                           // bytes in one allocation for each of the file
  bool exact;                                                  // nothing may follow the file
};

// A file is made by the tests that read it: each program of a single test would else make them all.
struct Sample {
  std::string name;
  std::function<Contents()> make;
};

void PrintTo(const Sample& sample, std::ostream* out) {
  *out << sample.name;
}

// Square, as the layout of 2017 needs it.
Table isotropicTable() {
  TableInfo info = test::smallTable().info();
  info.axes[0] = makeAxis("theta", "rad", AxisMap::kSqrtOneMinusCos, 4, 0.0, 0.5 * std::numbers::pi);
  std::vector<float> data = test::smallTable().data();
  data.insert(data.end(), data.begin(), data.begin() + 4 * 7);
  return Table(info, data);
}

Table anisotropicTable() {
  TableInfo info = test::smallTable().info();
  info.axes = {makeAxis("alpha", "1", AxisMap::kLinear, 2, 0.0, 1.0, 1e-4),
               makeAxis("lambda", "1", AxisMap::kLinear, 2, 0.0, 1.0),
               makeAxis("theta", "rad", AxisMap::kLinear, 2, 0.0, 0.5 * std::numbers::pi),
               makeAxis("phi", "rad", AxisMap::kLinear, 3, 0.0, 0.5 * std::numbers::pi)};
  info.channels = {"m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22", "norm", "fresnel"};
  info.normalization = MatrixNormalization::kNone;
  std::vector<float> data;
  for (int i = 0; i < 24; ++i) {
    const float v = 0.01f * static_cast<float>(i);
    data.insert(data.end(), {0.5f + v, v, -v, 0.1f, 0.7f, v, 0.2f, -v, 0.9f, 1.0f - v, v});
  }
  return Table(info, data);
}

std::optional<Table> readKtx2(std::string_view bytes) {
  const Ktx2File file = parseKtx2(bytes, "T");
  for (const auto& [key, value] : file.keyValues)
    if (key == kMetadataKey)
      return tableFromPacked(packedFromStack(packedFromMetadata(value, "T"), file.image, "T"), "T");
  return std::nullopt;
}

// A file of the format, and the reader that readTable would take for it.
Contents exportedNow(const Table& table, const std::string& format, const FormatOptions& options) {
  const ExportResult result = exportTable(table, *findFormat(format), options, "t");
  Contents sample{result.files[0].bytes, {}, 32, true};
  std::string metadata = result.files.size() > 1 ? result.files.back().bytes : std::string();
  if (format == "ktx2") {
    sample.read = readKtx2;
    sample.ratio = 256;
    sample.exact = false;
  } else if (format == "exr") {
    sample.read = [](std::string_view bytes) { return tableFromPacked(packedFromExr(bytes, "T"), "T"); };
    sample.ratio = 1032;
    sample.exact = false;
  } else if (format == "npy") {
    sample.read = [metadata](std::string_view bytes) {
      return tableFromPacked(
          packedFromNumbers(packedFromMetadata(metadata, "T"), parseNpy(bytes, "T").values, "T"), "T");
    };
  } else if (format == "dds") {
    sample.read = [metadata](std::string_view bytes) {
      return tableFromPacked(packedFromStack(packedFromMetadata(metadata, "T"), parseDds(bytes, "T"), "T"),
                             "T");
    };
  } else if (format == "bin") {
    sample.read = [metadata](std::string_view bytes) {
      PackedTable packed = packedFromMetadata(metadata, "T");
      const std::vector<float> numbers = readValues(bytes, packed.precision);
      return tableFromPacked(packedFromNumbers(std::move(packed), numbers, "T"), "T");
    };
  } else if (format == "json") {
    sample.read = [](std::string_view bytes) { return tableFromJson(bytes, "T"); };
  } else {
    sample.read = [](std::string_view bytes) { return tableFromSource(bytes, "T"); };
    sample.exact = false;
  }
  return sample;
}

Sample exported(const Table& table, const std::string& format, const FormatOptions& options,
                const std::string& name) {
  return {name, [=] { return exportedNow(table, format, options); }};
}

// A small form, read as the smallest table: the one that readTable makes has the same size for any file.
Contents chebyshev() {
  ChebyshevForm form;
  form.functions = {{{{2.0, -0.5}, {0.25}}, {{0.125}}, {{0.5}}, {{-0.25, 0.125}}, {{0.5}}, {{0.0625}}}};
  return {chebyshevToJson(form, {}),
          [](std::string_view bytes) { return tableOfChebyshev(chebyshevFromJson(bytes, "T"), 4); }, 32,
          true};
}

std::string withoutLastLine(const std::string& text) {
  return text.substr(0, text.rfind('\n', text.size() - 2) + 1);
}

// 64 x 64 texels in the layout of 2017, of PlayCanvas or Babylon.js.
Contents engineBinary(bool playCanvas) {
  std::vector<float> values(std::size_t{64} * 64 * 8);
  constexpr std::array<float, 8> kTexel{1.0f, -0.25f, 0.5f, 0.75f, 0.875f, 0.25f, 0.0f, 0.5f};
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = kTexel[playCanvas ? i % 4 + (i < values.size() / 2 ? 0 : 4) : i % 8];
  std::string bytes;
  if (playCanvas) append(bytes, std::uint32_t{0x00010000});
  appendValues(bytes, values, playCanvas ? Precision::kFloat : Precision::kHalf);
  return {bytes, [](std::string_view b) { return tableFromEngineBinary(b, "T"); }, 32, true};
}

// The description of a raw file; the numbers are as they were.
Contents metadataAlone(const Table& table) {
  const ExportResult raw = exportTable(table, *findFormat("bin"), {}, "t");
  const std::string numbers = raw.files[0].bytes;
  return {raw.files[1].bytes,
          [numbers](std::string_view bytes) {
            return tableFromPacked(packedFromNumbers(packedFromMetadata(bytes, "T"),
                                                     readValues(numbers, Precision::kFloat), "T"),
                                   "T");
          },
          32, true};
}

// One 2D texture a file: the first of two.
Contents firstOfTwo(const Table& table) {
  FormatOptions legacy;
  legacy.ddsHeader = DdsHeader::kLegacy;
  const ExportResult dds = exportTable(table, *findFormat("dds"), legacy, "t.dds");
  return {dds.files[0].bytes,
          [dds](std::string_view bytes) {
            PackedTable packed = packedFromMetadata(dds.files[2].bytes, "T");
            packed.images = {parseDds(bytes, "T"), parseDds(dds.files[1].bytes, "T")};
            return tableFromPacked(packed, "T");
          },
          32, true};
}

std::vector<Sample> samples() {
  std::vector<Sample> all;
  FormatOptions channels;
  channels.layout = Layout::kChannels;
  const Table iso = isotropicTable();
  const Table aniso = anisotropicTable();
  for (const bool anisotropic : {false, true}) {
    const Table& table = anisotropic ? aniso : iso;
    const std::string kind = anisotropic ? " aniso" : " iso";
    for (const Precision precision : {Precision::kFloat, Precision::kHalf}) {
      FormatOptions options;
      options.precision = precision;
      const std::string of = kind + (precision == Precision::kHalf ? " half" : " float");
      all.push_back(exported(table, "dds", options, "dds dx10" + of));
      all.push_back(exported(table, "ktx2", options, "ktx2 zstd" + of));
      options.ktx2Compression = Ktx2Compression::kNone;
      all.push_back(exported(table, "ktx2", options, "ktx2 plain" + of));
      all.push_back(exported(table, "exr", options, "exr packed" + of));
      all.push_back(exported(table, "bin", options, "raw" + of));
      options.layout = Layout::kChannels;
      all.push_back(exported(table, "exr", options, "exr channels" + of));
      all.push_back(exported(table, "npy", options, "npy" + of));
      options.layout = Layout::kPacked;
      options.ddsHeader = DdsHeader::kLegacy;
      if (anisotropic) all.push_back(exported(table, "dds", options, "dds legacy" + of));
    }
    all.push_back(exported(table, "json", channels, "json" + kind));
    all.push_back(exported(table, "h", {}, "header" + kind));
    all.push_back({"header" + kind + " without metadata", [table] {
                     Contents header = exportedNow(table, "h", {});
                     header.bytes = withoutLastLine(header.bytes);
                     return header;
                   }});
    all.push_back({"metadata" + kind, [table] { return metadataAlone(table); }});
  }
  all.push_back({"dds legacy iso", [iso] { return firstOfTwo(iso); }});
  all.push_back(exported(iso, "js", {}, "module"));
  const std::string arrays = "[[1,0,2,4],[1,0,2,4],[1,0,2,4],[1,0,2,4]]";
  for (const char* const language : {"pub const LTC_{}: [[f32; 4]; 4] = {};",
                                     "export const ltc{}: number[][] = {};", "ushort[][] s_ltc{} = {};"}) {
    const std::string form = language;
    const std::string of = form.substr(0, form.find('{'));
    const std::string second = form.starts_with("ushort")
                                   ? "[[0x3c00,0x3000],[0x3c00,0x3000],[0x3c00,0x3000],[0x3c00,0x3000]]"
                                   : "[[1,.25],[1,.25],[1,.25],[1,.25]]";
    all.push_back({"source " + of, [=] {
                     return Contents{fmt::format(fmt::runtime(form), 1, arrays) + "\n" +
                                         fmt::format(fmt::runtime(form), 2, second) + "\n",
                                     [](std::string_view bytes) { return tableFromSource(bytes, "T"); }, 64,
                                     false};
                   }});
  }
  all.push_back({"chebyshev", chebyshev});
  all.push_back({"PlayCanvas", [] { return engineBinary(true); }});
  all.push_back({"Babylon.js", [] { return engineBinary(false); }});
  return all;
}

class Robustness : public testing::TestWithParam<Sample> {
 protected:
  // Reads bytes of a heap block of exactly their length, so that a sanitizer sees a read beyond it. Anything
  // thrown but an InputError fails the test.
  std::optional<Table> read(std::string_view bytes) {
    const auto block = std::make_unique<char[]>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), block.get());
    test::largestAllocation = 0;
    std::optional<Table> table;
    try {
      table = sample_.read({block.get(), bytes.size()});
    } catch (const InputError&) {
    }
    const std::size_t most = test::largestAllocation;
    largest_ = std::max(largest_, most);
    EXPECT_LE(most, kConstant + sample_.ratio * bytes.size());
    return table;
  }
  void TearDown() override { RecordProperty("largest_allocation", std::to_string(largest_)); }
  // Parts of a file in which every byte is tried; small files are all tried.
  bool tryAll(std::size_t at, std::size_t size) const { return size <= 512 || at < 256 || at + 64 >= size; }

  const Contents sample_ = GetParam().make();
  std::size_t largest_ = 0;
};

TEST_P(Robustness, CutOffNothingIsLost) {
  const std::string& bytes = sample_.bytes;
  const std::optional<Table> whole = read(bytes);
  ASSERT_TRUE(whole);
  std::vector<float> expected = whole->data();
  std::sort(expected.begin(), expected.end());
  // the engines' binaries have no other place to be cut at than their length
  const std::size_t stride = bytes.size() > 32768 ? 13 : 1;
  for (std::size_t n = 0; n < bytes.size(); n += stride) {
    const std::optional<Table> table = read(std::string_view(bytes).substr(0, n));
    if (!table) continue;
    // a text may end before its metadata and yet hold the numbers, in the channels' order of the layout
    std::vector<float> data = table->data();
    std::sort(data.begin(), data.end());
    EXPECT_EQ(data, expected) << n << " of " << bytes.size();
    EXPECT_TRUE(!sample_.exact || n + 1 == bytes.size()) << n << " of " << bytes.size();
  }
}

TEST_P(Robustness, NothingMayFollow) {
  if (!sample_.exact) return;
  // what is no whole number behind a raw file, readTable sees
  const bool raw = GetParam().name.starts_with("raw");
  EXPECT_TRUE(raw || !read(sample_.bytes + "x"));
  EXPECT_FALSE(read(sample_.bytes + std::string(64, '\0')));
}

TEST_P(Robustness, SingleBits) {
  std::string bytes = sample_.bytes;
  const auto flip = [&](std::size_t at, int bit) {
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
    read(bytes);
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
  };
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    if (bytes.size() > 32768 ? at < 16 : tryAll(at, bytes.size()))
      for (int bit = 0; bit < 8; ++bit) flip(at, bit);
  }
  Random random(5);
  for (int i = 0; i < (bytes.size() > 32768 ? 100 : 1000); ++i) {
    const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(bytes.size()));
    flip(at, static_cast<int>(random.uniform() * 8.0));
  }
}

TEST_P(Robustness, AbsurdNumbers) {
  const std::string& bytes = sample_.bytes;
  const auto overwrite = [&](auto value, std::size_t at) {
    std::string damaged = bytes;
    std::memcpy(damaged.data() + at, &value, sizeof value);
    read(damaged);
  };
  const std::size_t end = std::min<std::size_t>(bytes.size(), bytes.size() > 32768 ? 16 : 256);
  for (std::size_t at = 0; at + 8 <= end; ++at) {
    for (std::uint32_t v : {0u, 1u, 0x4000u, 0x10000u, 0x7fffffffu, 0x80000000u, 0xffffffffu})
      overwrite(v, at);
    for (std::uint64_t v :
         {std::uint64_t{1} << 32, std::uint64_t{1} << 63, ~std::uint64_t{0}, std::uint64_t{0}})
      overwrite(v, at);
  }
}

INSTANTIATE_TEST_SUITE_P(Export, Robustness, testing::ValuesIn(samples()), [](const auto& test) {
  std::string name = test.param.name;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

TEST(RobustnessOf, SizesWhoseProductOverflows) {
  const auto patched = [](std::string bytes,
                          std::initializer_list<std::pair<std::size_t, std::uint32_t>> fields) {
    for (const auto& [at, value] : fields) std::memcpy(bytes.data() + at, &value, sizeof value);
    return bytes;
  };
  Image image;
  image.width = image.height = 2;
  image.values.assign(16, 1.0f);
  // 16384^4 texels of 16 bytes are 2^60 bytes, and 65536^4 are none in 64 bits
  for (std::uint32_t side : {16384u, 65536u}) {
    const std::string dds = imageToDds(image, DdsHeader::kDx10);
    EXPECT_THROW(parseDds(patched(dds, {{12, side}, {16, side}, {24, side}, {132, 4}, {140, side}}), "T"),
                 InputError);
    for (const auto compression : {Ktx2Compression::kNone, Ktx2Compression::kZstd}) {
      const std::string ktx = imageToKtx2({image, {}}, compression);
      const std::initializer_list<std::pair<std::size_t, std::uint32_t>> sizes{
          {20, side}, {24, side}, {28, side}, {32, side}, {96, 0}, {100, side == 16384 ? 1u << 28 : 0u}};
      EXPECT_THROW(parseKtx2(patched(ktx, sizes), "T"), InputError);
    }
  }
  for (const char* shape : {"4294967296, 4294967296", "18446744073709551617", "65536, 65536, 65536, 65536, 1",
                            "2147483648, 8589934592", "0, 1", "-1"}) {
    std::string npy = arrayToNpy({{1}, {1.0f}}, Precision::kFloat);
    const std::size_t at = npy.find("(1,)");
    const std::string tuple = "(" + std::string(shape) + ")}";
    npy.replace(at, tuple.size(), tuple);
    EXPECT_THROW(parseNpy(npy, "T"), InputError) << shape;
  }
  const std::string header = "float a[4294967296][4294967296][4294967296][2][9] = {1, 2, 3};";
  EXPECT_THROW(tableFromSource(header, "T"), InputError);
}

TEST(RobustnessOf, TimeIsThatOfOnePass) {
  // each of these takes minutes where a search starts again at every '=' or member
  const auto repeated = [](const std::string& text) {
    std::string out;
    while (out.size() < 1 << 20) out += text;
    return out;
  };
  const auto start = std::chrono::steady_clock::now();
  for (const char* text : {"]={", "=/*", "=//", "a[1]=[1,", "={-/*", "={", "=[[[[", "a:[", ":/*",
                           "a:b=", "a=b.of(", "=new a[1]", "a=[1]b=[2]", "a=0x", "a:((((="})
    arraysOfText(repeated(text));
  std::string json = "{";
  for (int i = 0; i < 200000; ++i) json.append("\"").append(std::to_string(i)).append("\":0,");
  EXPECT_THROW(tableFromJson(json.append("\"end\":0}"), "T"), InputError);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 20.0);
}

TEST(RobustnessOf, RawFileOfAnyLength) {
  const std::string path = testing::TempDir() + "ltcfit-robustness.bin";
  const ExportResult result = exportTable(isotropicTable(), *findFormat("bin"), {}, "t");
  writeFileAtomically(sidecarPath(path), result.files[1].bytes);
  std::string bytes = result.files[0].bytes;
  writeFileAtomically(path, bytes);
  EXPECT_EQ(readTable(path).nodeCount(), 16u);
  bytes += 'x';
  for (; !bytes.empty(); bytes.pop_back()) {
    if (bytes.size() == result.files[0].bytes.size()) continue;
    writeFileAtomically(path, bytes);
    EXPECT_THROW(readTable(path), InputError) << bytes.size();
  }
  std::filesystem::remove(path);
  std::filesystem::remove(sidecarPath(path));
}

TEST(RobustnessOf, NumbersBeyondFloat32) {
  // none of them is 0 because it is too large
  for (const char* large : {"1e39", "0.001e99", "4000000e33", "1e999", "-1e39"})
    EXPECT_TRUE(arraysOfText(std::string("a = {1, ") + large + "}").empty()) << large;
  for (const char* small : {"1e-50", "0.1e-999", "-1e-60"})
    EXPECT_EQ(arraysOfText(std::string("a = {") + small + "}").at(0).values.at(0), 0.0f) << small;
}

TEST(RobustnessOf, EmptyNumbers) {
  EXPECT_TRUE(readValues({}, Precision::kFloat).empty());
}

TEST(RobustnessOf, ExrComponentsBeyondItsChannels) {
  // a few bytes of metadata for each component must not ask for an image each
  const ExportResult result = exportTable(test::smallTable(), *findFormat("exr"), {}, "t");
  ExrFile file = parseExr(result.files[0].bytes, "T");
  for (auto& [key, value] : file.attributes) {
    if (key != kMetadataKey) continue;
    const std::size_t at = value.find("\"textures\": [") + 13;
    for (int i = 0; i < 8; ++i)
      value.insert(at, R"({"name": "amplitude", "components": ["m00", "m00", "m00", "m00"]},)");
  }
  try {
    tableFromPacked(packedFromExr(channelsToExr(file), "T"), "T");
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("fewer channels"), std::string::npos) << error.what();
  }
}

TEST(RobustnessOf, ExrHeadersThatMislead) {
  // each would have OpenEXR allocate by a number from the middle of the file, or decode what no table is
  const std::string good = exportTable(isotropicTable(), *findFormat("exr"), {}, "t").files[0].bytes;
  const auto with = [&](std::string_view attribute) { return std::string(good).insert(8, attribute); };
  const auto changed = [&](std::size_t at, char value) {
    std::string bytes = good;
    bytes[at] = value;
    return bytes;
  };
  using namespace std::string_literals;
  const auto reachesOpenExr = [](const std::string& bytes) {
    try {
      parseExr(bytes, "T");
    } catch (const InputError& error) {
      return std::string(error.what()).find("damaged") != std::string::npos;
    }
    return true;
  };
  // a sound attribute passes, and OpenEXR then misses the blocks, which have moved
  EXPECT_TRUE(reachesOpenExr(with("x\0int\0\4\0\0\0\0\0\0\0"s)));
  std::size_t count = 0;
  for (const std::string& bytes :
       {with("x\0int\0\5\0\0\0\0\0\0\0\0"s), with("x\0string\0\377\377\377\177"s),
        with("x\0idmanifest\0\4\0\0\0\377\377\377\177"s), with("x\0chlist\0\1\0\0\0\0"s),
        with("channels\0chlist\0\1\0\0\0a"s), with("type\0string\0\4\0\0\0deep"s), changed(5, 2 /* tiled */),
        changed(5, 16 /* multi-part */),
        changed(good.find("compression\0compression\0"s) + 28, 8 /* DWAA */)}) {
    EXPECT_FALSE(reachesOpenExr(bytes)) << count;
    ++count;
  }
}

TEST(RobustnessOf, TexturesAreFew) {
  std::string metadata = exportTable(isotropicTable(), *findFormat("bin"), {}, "t").files[1].bytes;
  const std::size_t at = metadata.find("\"textures\": [") + 13;
  for (int i = 0; i < 15; ++i) metadata.insert(at, R"({"name": "a", "components": ["m00"]},)");
  EXPECT_THROW(packedFromMetadata(metadata, "T"), InputError);
}

TEST(RobustnessOf, SourceThatLostAnArrayIsRefused) {
  const std::string four = "const LTC_MAT_1 = [1,0,2,4, 1,0,2,4, 1,0,2,4, 1,0,2,4];\n";
  const std::string two = "const LTC_MAT_2 = [1,.2, 1,.2, 1,.2, 1,.2];\n";
  EXPECT_TRUE(tableFromSource(four + two, "T"));
  for (const std::string& text :
       {four, four + "const LTC_MAT_2 = [1,.2, 1,.2", four + "const LTC_MAT_2 = [1,.2, 1,x];",
        four + "const LTC_MAT_2 = [1e999,2];", four + two + "/* ltcfit-met",
        four + two + "// ltcfit-metadata: ", four + two + "export const LTC_INFO = {",
        "\n#ifndef A\n" + four + two}) {
    EXPECT_THROW(tableFromSource(text, "T"), InputError) << text;
  }
}

}  // namespace
}  // namespace ltcfit
