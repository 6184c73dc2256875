#include "export/profiles.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>
#include <stdexcept>

#include "export/atomic_file.h"
#include "export/dds.h"
#include "export/ktx2.h"
#include "export/little_endian.h"
#include "export/packing.h"
#include "export/read_table.h"
#include "export/text_arrays.h"
#include "ltc/resample.h"

namespace ltcfit {
namespace {

const Table& isoTable() {
  static const Table table = readTable(LTCFIT_DATA_DIR "/ltc_iso.json");
  return table;
}

const Table& anisoTable() {
  static const Table table = readTable(LTCFIT_DATA_DIR "/ltc_aniso.json");
  return table;
}

ExportResult exported(const char* name, const Table& table, bool resample = false) {
  const Profile* const profile = findProfile(name);
  if (profile == nullptr) throw std::runtime_error(name);
  return exportProfile(table, *profile, resample, std::string(profile->files[0]));
}

// A folder that goes away.
class Folder {
 public:
  Folder() {
    char name[] = "/tmp/ltcfit-test-XXXXXX";
    path_ = ::mkdtemp(name);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string write(const std::vector<ExportFile>& files) const {
    for (const ExportFile& file : files) std::ofstream(path_ / file.name, std::ios::binary) << file.bytes;
    return path_ / files[0].name;
  }

 private:
  std::filesystem::path path_;
};

TEST(Profiles, EveryOneIsReadBackByName) {
  const Table iso2016 =
      resampled(isoTable(), {makeAxis("theta", "rad", AxisMap::kLinear, 64, 0.0, 0.5 * std::numbers::pi),
                             makeAxis("alpha", "1", AxisMap::kSqrt, 64, 0.0, 1.0, 1e-4)});
  for (const Profile& profile : profiles()) {
    const bool is2016 = profile.axes.theta == AxisMap::kLinear;
    const Table& table = !profile.axes.isotropic ? anisoTable() : is2016 ? iso2016 : isoTable();
    const ExportResult result = exportProfile(table, profile, true, std::string(profile.files[0]));
    EXPECT_EQ(findProfile(profile.name), &profile);
    for (std::size_t i = 0; i < profile.files.size(); ++i) EXPECT_EQ(result.files[i].name, profile.files[i]);
    if (profile.name == "unity-hdrp") continue;  // C# is not read back
    const Folder folder;
    const Table back = readTable(folder.write(result.files));
    ASSERT_EQ(back.info().axes.size(), table.info().axes.size()) << profile.name;
    EXPECT_TRUE(back.info().provenance.command.starts_with(table.info().provenance.command)) << profile.name;
    // the lobes, where the nodes are the same: not whole numbers of ulps, since M is inverted and scaled
    if (back.nodeCount() != table.nodeCount()) continue;
    for (std::size_t i = 0; i < table.nodeCount(); i += 7) {
      const TableEntry a = table.entry(table.node(i));
      const TableEntry b = back.entry(back.node(i));
      if (a.m.fullPivLu().rcond() < 1e-3) continue;
      const double tolerance = profile.half ? 2e-2 : 1e-3;  // of a matrix whose condition is up to 1e3
      const Eigen::Matrix3d ma = a.m / a.m.col(2).norm();
      const Eigen::Matrix3d mb = b.m / b.m.col(2).norm();
      EXPECT_LT((ma - mb).norm(), tolerance) << profile.name << " node " << i;
      EXPECT_NEAR(*b.norm, *a.norm, profile.half ? 2.5e-4 : 1e-7) << profile.name;
    }
  }
}

TEST(Profiles, BytesAreThoseOfTheEngines) {
  const Table& table = isoTable();
  const PackedTable packed = pack(table, packing2017(), Precision::kFloat);
  const PackedTable half = pack(table, packing2017(), Precision::kHalf);

  const std::string playcanvas = exported("playcanvas", table).files[0].bytes;
  ASSERT_EQ(playcanvas.size(), 131076u);
  EXPECT_EQ(readAt<std::int16_t>(playcanvas, 0), 0);
  EXPECT_EQ(readAt<std::int16_t>(playcanvas, 2), 1);
  EXPECT_EQ(readValues(std::string_view(playcanvas).substr(4, 65536), Precision::kFloat),
            packed.images[0].values);
  EXPECT_EQ(readValues(std::string_view(playcanvas).substr(65540), Precision::kFloat),
            packed.images[1].values);

  const std::string babylon = exported("babylon", table).files[0].bytes;
  ASSERT_EQ(babylon.size(), 65536u);
  for (std::size_t i = 0; i < 4096; ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      ASSERT_EQ(halfValue(readAt<std::uint16_t>(babylon, i * 16 + 2 * c)), half.images[0].values[i * 4 + c]);
      ASSERT_EQ(halfValue(readAt<std::uint16_t>(babylon, i * 16 + 8 + 2 * c)),
                half.images[1].values[i * 4 + c]);
    }
  }

  const Ktx2File bevy = parseKtx2(exported("bevy", table).files[0].bytes, "bevy");
  EXPECT_EQ(bevy.image.layers, 2u);
  EXPECT_EQ(bevy.image.precision, Precision::kHalf);
  EXPECT_EQ(readAt<std::uint32_t>(exported("bevy", table).files[0].bytes, 12), 97u);

  const ExportResult selfshadow = exported("selfshadow-dds", table);
  EXPECT_EQ(selfshadow.files[0].bytes.size(), 32896u);
  EXPECT_EQ(parseDds(selfshadow.files[1].bytes, "2").values, half.images[1].values);

  const ExportResult three = exported("three", table);
  for (const TextArray& array : arraysOfText(three.files[0].bytes)) {
    if (array.isMember) continue;  // of the description
    EXPECT_EQ(array.values, packed.images[array.name == "LTC_MAT_1" ? 0 : 1].values) << array.name;
  }
}

TEST(Profiles, LayoutsOf2016GodotAndHdrp) {
  const ExportResult godot = exported("godot", isoTable(), true);
  const Image lut1 = parseDds(godot.files[0].bytes, "1");
  const Image lut2 = parseDds(godot.files[1].bytes, "2");
  EXPECT_EQ(godot.files[0].bytes.size(), 148u + 65536u);
  const ExportResult o3de = exported("o3de", isoTable(), true);
  const Image matrix = parseDds(o3de.files[0].bytes, "1");
  const Image amplitude = parseDds(o3de.files[1].bytes, "2");
  EXPECT_EQ(matrix.width, 32u);
  EXPECT_EQ(amplitude.components, 2u);
  for (const auto& [theta, alpha] : {std::pair<std::size_t, std::size_t>{0, 63}, {40, 30}, {63, 10}}) {
    const double a = static_cast<double>(alpha) / 63;
    const TableEntry e =
        isoTable().fetch({a * a, a * a, 0.5 * std::numbers::pi * static_cast<double>(theta) / 63, 0.0});
    const Eigen::Matrix3d m = e.m / e.m.col(2).norm();
    const float* const v = lut1.values.data() + 4 * (theta * 64 + alpha);
    const float* const w = lut2.values.data() + 4 * (theta * 64 + alpha);
    EXPECT_NEAR(v[0], m(0, 0), 1e-6);
    EXPECT_NEAR(v[1], m(2, 0), 1e-6);
    EXPECT_NEAR(v[2], m(1, 1), 1e-6);
    EXPECT_NEAR(v[3], m(0, 2), 1e-6);
    EXPECT_NEAR(w[0], m(2, 2), 1e-6);
    EXPECT_NEAR(w[1], *e.norm, 1e-6);
    EXPECT_NEAR(w[2], *e.fresnel, 1e-6);
  }
  const double a = 20.0 / 31;
  const TableEntry e = isoTable().fetch({a * a, a * a, 0.5 * std::numbers::pi * 12.0 / 31, 0.0});
  const float* const t = matrix.values.data() + 4 * (12 * 32 + 20);
  EXPECT_NEAR(t[0], e.mInv(2, 2) / e.mInv(0, 0), 1e-5);
  EXPECT_NEAR(t[1], e.mInv(2, 0) / e.mInv(0, 0), 1e-5);
  EXPECT_NEAR(t[2], e.mInv(1, 1) / e.mInv(0, 0), 1e-5);
  EXPECT_NEAR(t[3], e.mInv(0, 2) / e.mInv(0, 0), 1e-5);

  const std::string hdrp = exported("unity-hdrp", isoTable()).files[0].bytes;
  std::vector<std::uint16_t> bits;
  for (std::size_t at = hdrp.find("new ushort[]"); (at = hdrp.find("0x", at)) != std::string::npos; at += 6)
    bits.push_back(static_cast<std::uint16_t>(std::stoul(hdrp.substr(at + 2, 4), nullptr, 16)));
  ASSERT_EQ(bits.size(), 4096u * 4u);
  const TableEntry node = isoTable().entry(std::vector<std::size_t>{30, 40});
  const Eigen::Matrix3d m = node.mInv / node.mInv(2, 2);
  const std::size_t texel = 4 * (30 * 64 + 40);
  const double expected[] = {m(0, 0), m(2, 0), m(1, 1), m(0, 2)};
  for (std::size_t c = 0; c < 4; ++c)  // an ulp of a half: 1/1024
    EXPECT_NEAR(halfValue(bits[texel + c]), expected[c], 1e-3 * std::abs(expected[c]));
}

TEST(Profiles, ATableOfOtherNodesIsRefusedWithTheCommandForTheRightOne) {
  for (const char* name : {"godot", "o3de", "anisotropic-2022"}) {
    try {
      exported(name, isoTable());
      ADD_FAILURE() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(fitCommand(*findProfile(name))), std::string::npos)
          << error.what();
    }
  }
  EXPECT_THROW(exported("three", anisoTable(), true), std::invalid_argument);
  EXPECT_NO_THROW(exported("godot", isoTable(), true));
}

TEST(Profiles, PlayCanvasWarnsOutsideOfItsRanges) {
  // norm is 0.306853 at alpha 1 and normal view: below the range by less than 8 bits show
  EXPECT_TRUE(exported("playcanvas", isoTable()).warnings.empty());
  const TableInfo info = isoTable().info();
  std::vector<float> data = isoTable().data();
  data[5] = 0.1f;
  EXPECT_EQ(exported("playcanvas", Table(info, data)).warnings.size(), 1u);
}

TEST(Profiles, AllOfOneTableTakeLessThanASecond) {
  const auto start = std::chrono::steady_clock::now();
  std::size_t count = 0;
  for (const Profile& profile : profiles()) {
    if (profile.axes.isotropic) count += exportProfile(isoTable(), profile, true, "x").files.size();
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("%zu files in %.2f s\n", count, seconds);
  EXPECT_GT(count, 10u);
#if defined(NDEBUG) && !defined(LTCFIT_SANITIZED)
  EXPECT_LT(seconds, 1.0);
#endif
}

}  // namespace
}  // namespace ltcfit
