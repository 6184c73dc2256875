// Tables made for a scene, sub-ranges, warps, axes of one node, channels left out, through every format.
#include "tests/support/tailored.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "export/formats.h"
#include "export/json_table.h"
#include "export/ktx2.h"
#include "export/profiles.h"
#include "export/read_table.h"

namespace ltcfit::test {
namespace {

class TailoredExport : public testing::Test {
 protected:
  TailoredExport() {
    char name[] = "/tmp/ltcfit-test-XXXXXX";
    folder_ = ::mkdtemp(name);
  }
  ~TailoredExport() override { std::filesystem::remove_all(folder_); }

  std::vector<ExportFile> write(const Table& table, const char* format, const FormatOptions& options) {
    const FormatInfo& info = *findFormat(format);
    std::vector<ExportFile> files =
        exportTable(table, info, options, std::string("t") + std::string(info.extension)).files;
    for (const ExportFile& file : files) std::ofstream(folder_ / file.name, std::ios::binary) << file.bytes;
    return files;
  }
  Table roundTrip(const Table& table, const char* format, const FormatOptions& options) {
    return readTable(folder_ / write(table, format, options)[0].name);
  }

  std::filesystem::path folder_;
};

std::string messageOf(const Table& table, const char* format, const FormatOptions& options) {
  try {
    exportTable(table, *findFormat(format), options, "t");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST_F(TailoredExport, ChannelsAreLossless) {
  FormatOptions options;
  options.layout = Layout::kChannels;
  for (const Tailored& t : tailoredTables()) {
    for (const char* format : {"json", "npy", "exr", "ktx2", "dds", "bin"})
      EXPECT_EQ(tableToJson(roundTrip(t.table, format, options)), tableToJson(t.table)) << t.name << format;
  }
}

TEST_F(TailoredExport, LeanIsLosslessAndAsSmallAsItSays) {
  for (const Tailored& t : tailoredTables()) {
    for (Precision precision : {Precision::kFloat, Precision::kHalf}) {
      FormatOptions options;
      options.layout = Layout::kLean;
      options.precision = precision;
      const Table once = unpack(pack(t.table, packingLean(t.table.info()), precision));
      if (precision == Precision::kFloat) {
        EXPECT_EQ(once.data(), t.table.data());
      }
      for (const char* format : {"npy", "exr", "ktx2", "dds", "bin"})
        EXPECT_EQ(tableToJson(roundTrip(t.table, format, options)), tableToJson(once)) << t.name << format;
      EXPECT_EQ(write(t.table, "bin", options)[0].bytes.size(), leanSize(t.table.info(), precision).bytes);
    }
    // the second of two files does as well
    FormatOptions lean;
    lean.layout = Layout::kLean;
    for (const char* format : {"dds", "ktx2", "npy"}) {
      const std::vector<ExportFile> files = write(t.table, format, lean);
      const bool two = leanSize(t.table.info(), Precision::kFloat).textures == 2;
      EXPECT_EQ(files[0].name, two ? std::string("t-1.") + format : std::string("t.") + format) << t.name;
      if (two) {
        EXPECT_EQ(readTable(folder_ / files[1].name).data(), t.table.data()) << t.name << format;
      }
    }
  }
}

TEST_F(TailoredExport, LeanSizes) {
  const auto sizeOf = [](const char* name) {
    return leanSize(tailoredTable(name).info(), Precision::kFloat);
  };
  EXPECT_EQ(sizeOf("isoRange").bytes, 11u * 7 * (4 + 2) * 4);
  EXPECT_EQ(sizeOf("isoRange").textures, 2u);
  EXPECT_EQ(sizeOf("isoRow").bytes, 9u * (4 + 1) * 4);
  EXPECT_EQ(sizeOf("isoLinear").bytes, 12u * 6 * 4 * 4);
  EXPECT_EQ(sizeOf("isoLinear").textures, 1u);
  EXPECT_EQ(sizeOf("anisoTheta").bytes, 3u * 6 * 4 * 4);
  EXPECT_EQ(sizeOf("anisoTheta").textures, 1u);
  EXPECT_EQ(leanSize(tailoredTable("anisoRange").info(), Precision::kHalf).bytes, 3u * 4 * 3 * 6 * 5 * 4 * 2);
}

// Of one lambda and one alpha too, whose rows are three slices.
TEST_F(TailoredExport, AnisotropicTexturesAreVolumes) {
  FormatOptions options;
  options.layout = Layout::kLean;
  const Image image = parseKtx2(write(tailoredTable("anisoTheta"), "ktx2", options)[0].bytes, "t").image;
  EXPECT_EQ(image.width, 1u);
  EXPECT_EQ(image.height, 6u);
  EXPECT_EQ(image.depth, 3u);
  EXPECT_EQ(image.layers, 1u);
}

TEST_F(TailoredExport, HeadersHoldWhatThereIs) {
  for (const Tailored& t : tailoredTables()) {
    const Table back = roundTrip(t.table, "h", {});
    EXPECT_EQ(back.data(), t.table.data()) << t.name;
    EXPECT_EQ(back.info().channels, t.table.info().channels) << t.name;
  }
  const std::string row = write(tailoredTable("isoRow"), "h", {})[0].bytes;
  EXPECT_NE(row.find("t_amplitude[9][1]"), std::string::npos);
  EXPECT_NE(row.find("one node, whatever the alpha"), std::string::npos);
}

TEST_F(TailoredExport, WhatHasNoRoomIsRefusedByTheAxis) {
  for (const char* format : {"dds", "ktx2", "js", "bin", "glsl"}) {
    EXPECT_NE(messageOf(tailoredTable("isoRow"), format, {}).find("axis 'alpha' has one node"),
              std::string::npos)
        << format;
    EXPECT_EQ(messageOf(tailoredTable("isoRange"), format, {}), "") << format;
  }
  FormatOptions lean;
  lean.layout = Layout::kLean;
  for (const char* format : {"js", "h", "json", "glsl"})
    EXPECT_NE(messageOf(tailoredTable("isoRange"), format, lean).find("one layout only"), std::string::npos);
  FormatOptions packed;
  for (const char* format : {"glsl-lookup", "hlsl-lookup"})
    EXPECT_NE(messageOf(tailoredTable("isoRange"), format, packed).find("one layout only"),
              std::string::npos);
}

TEST_F(TailoredExport, ProfilesDoNotInventWhatATableLacks) {
  for (const Profile& profile : profiles()) {
    const Table& table = tailoredTable(profile.axes.isotropic ? "isoRange" : "anisoRange");
    for (bool resample : {false, true}) {
      std::string message;
      try {
        exportProfile(table, profile, resample, "t");
      } catch (const std::invalid_argument& error) {
        message = error.what();
      }
      const char* const wanted = resample                 ? "axis '"
                                 : profile.axes.isotropic ? "11 alpha (sqrt, warped)"
                                                          : "3 lambda (linear, 0.2 to 1)";
      EXPECT_NE(message.find(wanted), std::string::npos) << profile.name << ": " << message;
    }
  }
}

}  // namespace
}  // namespace ltcfit::test
