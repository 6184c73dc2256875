#include "export/texture_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "export/atomic_file.h"
#include "export/exr.h"
#include "export/formats.h"
#include "export/json_table.h"
#include "export/little_endian.h"
#include "export/read_table.h"
#include "export/texture_metadata.h"
#include "tests/support/small_table.h"

namespace ltcfit {
namespace {

// Writes an export into a folder of its own and reads it back by content.
Table roundTrip(const Table& table, const char* format, FormatOptions options) {
  char name[] = "/tmp/ltcfit-test-XXXXXX";
  const std::filesystem::path folder = ::mkdtemp(name);
  const FormatInfo& info = *findFormat(format);
  const ExportResult result = exportTable(table, info, options, "a_file.of_any_name");
  for (const ExportFile& file : result.files)
    std::ofstream(folder / file.name, std::ios::binary) << file.bytes;
  Table back = readTable(folder / result.files[0].name);
  std::filesystem::remove_all(folder);
  return back;
}

void expectSameInfo(const Table& a, const Table& b) {
  ASSERT_EQ(a.info().axes.size(), b.info().axes.size());
  for (std::size_t i = 0; i < a.info().axes.size(); ++i) {
    EXPECT_EQ(a.info().axes[i].values, b.info().axes[i].values);
    EXPECT_EQ(a.info().axes[i].map, b.info().axes[i].map);
    EXPECT_EQ(a.info().axes[i].high, b.info().axes[i].high);
  }
  EXPECT_EQ(a.info().stores, b.info().stores);
  EXPECT_EQ(a.info().normalization, b.info().normalization);
  EXPECT_EQ(a.info().channels, b.info().channels);
  EXPECT_EQ(a.info().alphaFloor, b.info().alphaFloor);
  EXPECT_EQ(a.info().provenance.command, b.info().provenance.command);
  EXPECT_EQ(a.info().provenance.options, b.info().provenance.options);
}

std::vector<Table> tables() {
  return {test::smallTable(), readTable(LTCFIT_DATA_DIR "/ltc_iso.json"),
          readTable(LTCFIT_DATA_DIR "/ltc_aniso.json")};
}

TEST(Formats, LosslessOnesGiveTheSameTable) {
  for (const Table& table : tables()) {
    for (const char* format : {"json", "npy", "exr", "ktx2", "dds", "bin"}) {
      FormatOptions options;
      options.layout = Layout::kChannels;
      const Table back = roundTrip(table, format, options);
      EXPECT_EQ(back.data(), table.data()) << format;
      expectSameInfo(back, table);
      EXPECT_EQ(tableToJson(back), tableToJson(table)) << format;
    }
    if (table.isIsotropic()) continue;
    EXPECT_EQ(tableToJson(roundTrip(table, "h", {})), tableToJson(table));
  }
}

// What a shader reads is the same in every container, and stays when written again.
TEST(Formats, PackedOnesAgree) {
  for (const Table& table : tables()) {
    const Table first = roundTrip(table, "ktx2", {});
    for (const char* format : {"npy", "exr", "dds", "bin", "h", "js"}) {
      EXPECT_EQ(roundTrip(table, format, {}).data(), first.data()) << format;
      EXPECT_EQ(roundTrip(first, format, {}).data(), first.data()) << format;
    }
    FormatOptions legacy;
    legacy.ddsHeader = DdsHeader::kLegacy;
    EXPECT_EQ(roundTrip(table, "dds", legacy).data(), first.data());
  }
}

TEST(Formats, HalvesAreExactlyTheRoundedNumbers) {
  const std::vector<Table> all = tables();
  for (std::size_t i = 1; i < all.size(); ++i) {
    for (Layout layout : {Layout::kPacked, Layout::kChannels}) {
      FormatOptions options;
      options.precision = Precision::kHalf;
      options.layout = layout;
      const Table rounded = roundTrip(all[i], "ktx2", options);
      for (const char* format : {"npy", "exr", "dds", "bin"})
        EXPECT_EQ(roundTrip(all[i], format, options).data(), rounded.data()) << format;
    }
  }
}

TEST(Formats, WhatAFormatDoesNotHaveIsRefused) {
  const Table table = test::smallTable();
  FormatOptions half;
  half.precision = Precision::kHalf;
  FormatOptions prefix;
  prefix.prefix = "x";
  FormatOptions channels;
  channels.layout = Layout::kChannels;
  for (const char* format : {"h", "glsl", "hlsl", "js", "json"})
    EXPECT_THROW(exportTable(table, *findFormat(format), half, "x"), std::invalid_argument) << format;
  for (const char* format : {"js", "dds", "npy"})
    EXPECT_THROW(exportTable(table, *findFormat(format), prefix, "x"), std::invalid_argument) << format;
  EXPECT_THROW(exportTable(table, *findFormat("js"), channels, "x"), std::invalid_argument);
  EXPECT_EQ(findFormat("png"), nullptr);
}

TEST(Exr, ChannelsAreNamedAfterCoefficients) {
  const Table table = readTable(LTCFIT_DATA_DIR "/ltc_aniso.json");
  FormatOptions options;
  options.layout = Layout::kChannels;
  const ExrFile file = parseExr(exportTable(table, *findFormat("exr"), options, "x").files[0].bytes, "x");
  EXPECT_EQ(file.width, 64u);
  EXPECT_EQ(file.height, 64u);
  EXPECT_EQ(file.names.size(), 11u);
  // x = phi + 8 theta, y = lambda + 8 alpha
  const std::vector<std::size_t> node{3, 5, 2, 7};
  for (std::size_t c = 0; c < file.names.size(); ++c) {
    const std::string& name = file.names[c];
    const auto channel = std::find(table.info().channels.begin(), table.info().channels.end(), name);
    ASSERT_NE(channel, table.info().channels.end());
    const auto offset = static_cast<std::size_t>(channel - table.info().channels.begin());
    EXPECT_EQ(file.channels[c][(5 + 8 * 3) * 64 + 7 + 8 * 2], table.data()[table.index(node) + offset])
        << name;
  }
}

// A sidecar that lies beside another file than its own, as after a copy or a half-finished export.
TEST(Metadata, MustBeThoseOfTheFile) {
  char name[] = "/tmp/ltcfit-test-XXXXXX";
  const std::filesystem::path folder = ::mkdtemp(name);
  const auto write = [&](const std::string& file, const std::string& bytes) {
    std::ofstream(folder / file, std::ios::binary) << bytes;
  };
  const Table iso = readTable(LTCFIT_DATA_DIR "/ltc_iso.json");
  FormatOptions legacy;
  legacy.ddsHeader = DdsHeader::kLegacy;
  const std::vector<ExportFile> files = exportTable(iso, *findFormat("dds"), legacy, "t.dds").files;
  ASSERT_EQ(files.size(), 4u);  // t-1.dds, t-2.dds and a description for each
  for (const ExportFile& file : files) write(file.name, file.bytes);
  EXPECT_EQ(readTable(folder / "t-1.dds").data(), readTable(folder / "t-2.dds").data());
  // renamed, with its description: the second file is found by name, and is the right one
  write("moved.dds", files[0].bytes);
  write("moved.dds.json", files[2].bytes);
  EXPECT_EQ(readTable(folder / "moved.dds").data(), readTable(folder / "t-1.dds").data());
  // another file under the name of the second
  write("t-2.dds", files[0].bytes);
  EXPECT_THROW(readTable(folder / "t-1.dds"), InputError);
  EXPECT_THROW(readTable(folder / "moved.dds"), InputError);
  std::filesystem::remove(folder / "t-2.dds");
  EXPECT_THROW(readTable(folder / "t-1.dds"), InputError);
  // the description of another export
  FormatOptions channels;
  channels.layout = Layout::kChannels;
  write("small.npy",
        exportTable(test::smallTable(), *findFormat("npy"), channels, "small.npy").files[0].bytes);
  write("small.npy.json", files[2].bytes);
  EXPECT_THROW(readTable(folder / "small.npy"), InputError);
  // one that was reformatted is the same
  const std::string spread = "{" + std::string(5000, '\n') + files[2].bytes.substr(1);
  write("t-2.dds", files[1].bytes);
  write("t-1.dds.json", spread);
  EXPECT_EQ(readTable(folder / "t-1.dds").info().provenance.command, iso.info().provenance.command);
  std::filesystem::remove_all(folder);
}

// Comments of headers are rewrapped by formatters.
TEST(Metadata, SurviveAFormatter) {
  const Table table = readTable(LTCFIT_DATA_DIR "/ltc_aniso.json");
  std::string header = exportTable(table, *findFormat("h"), {}, "t").files[0].bytes;
  const std::size_t line = header.rfind("ltcfit-metadata: ");
  for (std::size_t at = line; (at = header.find(' ', at)) != std::string::npos; at += 60) {
    if (at > header.size() - 8) break;
    header.replace(at, 1, "\n * ");
  }
  EXPECT_EQ(metadataOfSource(header),
            metadataOfSource(exportTable(table, *findFormat("h"), {}, "t").files[0].bytes));
}

TEST(Metadata, OfAnotherFileIsRefused) {
  const Table table = test::smallTable();
  const PackedTable packed = pack(table, packing2017(), Precision::kFloat);
  const std::string good = textureMetadata(packed, kRawContainer);
  EXPECT_NO_THROW(packedFromMetadata(good, "m"));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string bad = good;
    const std::size_t at = bad.find(from);
    if (at == std::string::npos) throw std::runtime_error(from);
    return bad.replace(at, from.size(), to);
  };
  for (const auto& [from, to] : {std::pair<const char*, const char*>{"\"version\": 1", "\"version\": 2"},
                                 {"\"ggx\"", "\"ggy\""},
                                 {"\"Minv\"", "\"N\""},
                                 {"\"m11\"", "\"m12\""},
                                 {"\"scale\": 1.0", "\"scale\": 3.0"},
                                 {"\"scale\": 1.0", "\"scale\": 0.0"},
                                 {"\"float32\"", "\"float64\""},
                                 {"\"components\"", "\"component\""},
                                 {"\"axes\"", "\"axe\""}}) {
    EXPECT_THROW(packedFromMetadata(with(from, to), "m"), InputError) << from;
  }
  EXPECT_THROW(
      packedFromMetadata(
          with("\"container\"", "\"files\": [{\"name\": \"../x\", \"checksum\": \"0\"}], \"container\""),
          "m"),
      InputError);
  EXPECT_THROW(packedFromNumbers(packedFromMetadata(good, "m"), std::vector<float>(95), "m"), InputError);
  EXPECT_THROW(packedFromNumbers(packedFromMetadata(good, "m"), std::vector<float>(97), "m"), InputError);
}

}  // namespace
}  // namespace ltcfit
