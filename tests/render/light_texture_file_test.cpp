// Prefiltered textures through every kind of file.
#include "render/light_texture_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "export/atomic_file.h"
#include "export/little_endian.h"
#include "render/light_textures.h"

namespace ltcfit {
namespace {

PrefilteredTexture example() {
  PrefilterOptions options;
  options.margin = 0.3;
  options.aspect = 2.0;
  options.threads = 1;
  return prefilter(stainedGlass(24, 1), options);
}

// Of this process: tests run beside each other.
std::string temporaryFolder() {
  const std::string folder = fmt::format("{}ltcfit-light-{}", testing::TempDir(), ::getpid());
  std::filesystem::create_directories(folder);
  return folder + "/";
}

void write(const std::vector<ExportFile>& files) {
  for (const ExportFile& file : files) writeFileAtomically(temporaryFolder() + file.name, file.bytes);
}

void remove(const std::vector<ExportFile>& files) {
  for (const ExportFile& file : files) std::filesystem::remove(temporaryFolder() + file.name);
}

TEST(LightTextureFiles, ComeBackAsTheyWere) {
  const PrefilteredTexture texture = example();
  for (const char* name : {"ltcfit-light.ktx2", "ltcfit-light.dds", "ltcfit-light.exr"}) {
    for (const Precision precision : {Precision::kHalf, Precision::kFloat}) {
      const auto files =
          lightTextureFiles(toLightTextureFile(texture, precision), name, Ktx2Compression::kZstd);
      write(files);
      const PrefilteredTexture back = fromLightTextureFile(readLightTexture(temporaryFolder() + name));
      EXPECT_EQ(back.margin, texture.margin);
      EXPECT_EQ(back.aspect, texture.aspect);
      EXPECT_EQ(back.lodScale, texture.lodScale);
      ASSERT_EQ(back.levels.size(), texture.levels.size());
      for (std::size_t l = 0; l < back.levels.size(); ++l) {
        ASSERT_EQ(back.levels[l].size, texture.levels[l].size);
        for (std::size_t i = 0; i < back.levels[l].texels.size(); ++i) {
          for (Eigen::Index c = 0; c < 3; ++c) {
            const auto value = static_cast<float>(texture.levels[l].texels[i][c]);
            const float expected = precision == Precision::kHalf ? halfValue(halfBits(value)) : value;
            ASSERT_EQ(back.levels[l].texels[i][c], static_cast<double>(expected)) << name;
          }
        }
      }
      remove(files);
    }
  }
  std::filesystem::remove_all(temporaryFolder());
}

TEST(LightTextureFiles, WhatIsNotOne) {
  const LightTextureFile good = toLightTextureFile(example(), Precision::kHalf);
  EXPECT_THROW(lightTextureFiles(good, "x.png", Ktx2Compression::kNone), std::invalid_argument);
  LightTextureFile fewer = good;
  fewer.levels.pop_back();
  EXPECT_THROW(lightTextureFiles(fewer, "x.dds", Ktx2Compression::kNone), std::invalid_argument);

  const std::string folder = temporaryFolder();
  std::vector<ExportFile> files = lightTextureFiles(good, "ltcfit-light.dds", Ktx2Compression::kNone);
  ASSERT_EQ(files.size(), 2u);
  files[0].bytes.back() = static_cast<char>(files[0].bytes.back() ^ 1);
  write(files);
  EXPECT_THROW(readLightTexture(folder + files[0].name), InputError);  // not the one described
  std::filesystem::remove(folder + files[1].name);
  EXPECT_THROW(readLightTexture(folder + files[0].name), InputError);  // no description
  remove(files);
  const std::string path = folder + "ltcfit-light.ktx2";
  writeFileAtomically(path, mipsToKtx2({good.levels, {}}, Ktx2Compression::kNone));
  EXPECT_THROW(readLightTexture(path), InputError);
  const std::string negative =
      R"({"format": "ltc-light-texture", "version": 1, "margin": 0.5, "aspect": 1, "lod_scale": -2})";
  writeFileAtomically(path, mipsToKtx2({good.levels, {{kMetadataKey, negative}}}, Ktx2Compression::kNone));
  EXPECT_THROW(readLightTexture(path), InputError);
  writeFileAtomically(path, "hello");
  EXPECT_THROW(readLightTexture(path), InputError);
  std::filesystem::remove_all(folder);
}

TEST(LightTextureFiles, ValuesBeyondHalf) {
  PrefilterOptions options;
  options.threads = 1;
  const PrefilteredTexture bright = prefilter({"", 1, 1, {Eigen::Vector3d(1.0, 7e4, 1.0)}}, options);
  try {
    toLightTextureFile(bright, Precision::kHalf);
    ADD_FAILURE() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "a radiance of 70000 is too large for half precision; take --float");
  }
  EXPECT_NO_THROW(toLightTextureFile(bright, Precision::kFloat));
}

}  // namespace
}  // namespace ltcfit
