#include "export/profiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>

#include "base/angles.h"
#include "base/refusal.h"
#include "export/anisotropic_c_header.h"
#include "export/engine_source.h"
#include "export/js_module.h"
#include "export/layouts.h"
#include "export/little_endian.h"
#include "export/texture_metadata.h"
#include "ltc/resample.h"

namespace ltcfit {
namespace {

constexpr ProfileAxes k2017{};
constexpr ProfileAxes k2016{true, AxisMap::kLinear, 64, 64};
constexpr ProfileAxes k2016Small{true, AxisMap::kLinear, 32, 32};
constexpr ProfileAxes k2022{false, AxisMap::kLinear, 0, 0};

// The layout of 2017 with the amplitudes and the sphere table in textures of their own.
Packing packingOfBlender() {
  return {MatrixStorage::kMinv,
          Divisor::kM11,
          {{"ltc_mat_ggx", {"m00", "m20", "m02", "m22"}},
           {"ltc_mag_ggx", {"norm", "fresnel"}},
           {"ltc_disk_integral", {"sphere"}}}};
}

Packing packingOfUnreal() {
  return {MatrixStorage::kMinv,
          Divisor::kM11,
          {{"LTCMat", {"m00", "m20", "m02", "m22"}}, {"LTCAmp", {"norm", "fresnel"}}}};
}

bool isAxis(const Axis& axis, AxisMap map, std::size_t nodes, double high) {
  return axis.size() == nodes && axis.spans(map, high);
}

std::string describeAxes(const Table& table) {
  std::string text;
  for (const Axis& axis : table.info().axes) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", axis.size(), axis.name);
    if (axis.map == AxisMap::kNone) continue;
    const double full = axis.unit == "rad" ? kHalfPi : 1.0;
    text += fmt::format(" ({}{}{})", axisMapName(axis.map),
                        axis.spans(axis.map, full) || axis.warp != AxisWarp{}
                            ? ""
                            : fmt::format(", {:.4g} to {:.4g}", axis.low, axis.high),
                        axis.warp == AxisWarp{} ? "" : ", warped");
  }
  return text;
}

Table withAxes(const Table& table, const Profile& profile, bool resample) {
  if (fitsProfile(table, profile)) return table;
  const std::string hint =
      fmt::format("profile {} needs {}, and this table has {}: `{}` makes the right one", profile.name,
                  profile.layout, describeAxes(table), fitCommand(profile));
  if (table.isIsotropic() != profile.axes.isotropic) throw Refusal(hint);
  if (!resample) throw Refusal(hint + ", --resample interpolates this one");
  const double floor = table.info().alphaFloor;
  if (!profile.axes.isotropic) {
    return resampled(table, {makeAxis("alpha", "1", AxisMap::kLinear, 8, 0.0, 1.0, floor),
                             makeAxis("lambda", "1", AxisMap::kLinear, 8, 0.0, 1.0),
                             makeAxis("theta", "rad", AxisMap::kLinear, 8, 0.0, kHalfPi),
                             makeAxis("phi", "rad", AxisMap::kLinear, 8, 0.0, kHalfPi)});
  }
  return resampled(table,
                   {makeAxis("theta", "rad", profile.axes.theta, profile.axes.thetaNodes, 0.0, kHalfPi),
                    makeAxis("alpha", "1", AxisMap::kSqrt, profile.axes.alphaNodes, 0.0, 1.0, floor)});
}

void needAmplitudes(const Table& table, const Profile& profile) {
  const std::vector<std::string>& c = table.info().channels;
  for (const char* channel : {"norm", "fresnel"}) {
    if (std::find(c.begin(), c.end(), channel) == c.end())
      throw Refusal(
          fmt::format("profile {} needs the channel {}, which this table lacks", profile.name, channel));
  }
}

// PlayCanvas falls back to 8 bits where half and float textures are not to be had, with ranges of the 2017
// table.
std::vector<std::string> playCanvasWarnings(const PackedTable& packed) {
  struct Range {
    std::size_t texture, component;
    double low, high;
    const char* name;
  };
  constexpr double kAny = std::numeric_limits<double>::infinity();
  constexpr double kHalfStep = 0.5 / 255.0;  // of 8 bits over a unit range: nothing that they could show
  constexpr std::array<Range, 4> kRanges{{{0, 1, -0.2976, kAny, "Minv20"},
                                          {0, 2, -0.01381, kAny, "Minv02"},
                                          {0, 3, -kAny, 1.6577, "Minv22"},
                                          {1, 0, 0.306897, kAny, "norm"}}};
  std::vector<std::string> warnings;
  for (const Range& range : kRanges) {
    const Image& image = packed.images[range.texture];
    std::size_t outside = 0;
    double worst = 0.0;
    double value = 0.0;
    for (std::size_t i = 0; i < image.texels(); ++i) {
      const double v = static_cast<double>(image.values[i * image.components + range.component]);
      const double excess = std::max(range.low - v, v - range.high);
      if (!(excess > kHalfStep)) continue;
      ++outside;
      if (excess > worst) {
        worst = excess;
        value = v;
      }
    }
    if (outside == 0) continue;
    const bool low = range.low > -kAny;
    warnings.push_back(
        fmt::format("{} is {} at {} texels, {} {} that PlayCanvas has built in for devices without half or "
                    "float textures "
                    "(8 bits): these clamp it",
                    range.name, value, outside, low ? "below" : "above", low ? range.low : range.high));
  }
  return warnings;
}

}  // namespace

const std::vector<Profile>& profiles() {
  static const std::vector<Profile> list{
      {"three",
       "three.js, RectAreaLightTexturesLib",
       "64 x 64, 2017 axes: ES module with LTC_MAT_1, LTC_MAT_2",
       k2017,
       {"ltc_three.js"}},
      {"babylon",
       "Babylon.js, scene.areaLightLTCProvider",
       "64 x 64, 2017 axes: 8 halves a texel, t1 then t2",
       k2017,
       {"areaLightsLTC.bin"},
       true},
      {"playcanvas",
       "PlayCanvas, app.setAreaLightLuts",
       "64 x 64, 2017 axes: int16 0, int16 1, float t1, float t2",
       k2017,
       {"area-light-luts.bin"}},
      {"bevy",
       "Bevy, rectangular area lights",
       "64 x 64, 2017 axes: KTX2, RGBA16F, 2 layers, zstd",
       k2017,
       {"ltc.ktx2"},
       true},
      {"eevee",
       "Blender EEVEE, eevee_lut.cc",
       "64 x 64, 2017 axes: C++ arrays ltc_mat_ggx, ltc_mag_ggx, ltc_disk_integral",
       k2017,
       {"eevee_lut_ltc.cc"}},
      {"unreal", "Unreal Engine, LTC.h", "64 x 64, 2017 axes: C++ arrays LTCMat, LTCAmp", k2017, {"LTC.h"}},
      {"unity-hdrp",
       "Unity HDRP, LtcData.GGX",
       "64 x 64, 2017 axes: C# ushort[] of halves, (m00, m20, m11, m02) / m22 of Minv",
       k2017,
       {"LtcData.GGX.cs"},
       true},
      {"o3de",
       "O3DE Atom, textures/ltc",
       "32 x 32, 2016 axes: float DDS pair, (m22, m20, m11, m02) / m00 of Minv; (norm, Fresnel)",
       k2016Small,
       {"ltc_mat_lutrgba32f.dds", "ltc_amp_lutrg32f.dds"}},
      {"godot",
       "Godot 4, area lights",
       "64 x 64, 2016 axes: float DDS pair, M: (m00, m20, m11, m02), (m22, norm, Fresnel, 0)",
       k2016,
       {"ltc_lut1.dds", "ltc_lut2.dds"}},
      {"selfshadow-dds",
       "the demo of 2017 and its users",
       "64 x 64, 2017 axes: half DDS pair, legacy header",
       k2017,
       {"ltc_1.dds", "ltc_2.dds"},
       true},
      {"anisotropic-2022",
       "the demo of 2022 and its users",
       "8 x 8 x 8 x 8, linear axes: float anisomats[8][8][8][8][9]",
       k2022,
       {"anisomats.h"}},
  };
  return list;
}

const Profile* findProfile(std::string_view name) {
  for (const Profile& profile : profiles()) {
    if (profile.name == name) return &profile;
  }
  return nullptr;
}

bool fitsProfile(const Table& table, const Profile& profile) {
  const std::vector<Axis>& axes = table.info().axes;
  if (table.isIsotropic() != profile.axes.isotropic) return false;
  if (profile.axes.isotropic) {
    return isAxis(axes[0], profile.axes.theta, profile.axes.thetaNodes, kHalfPi) &&
           isAxis(axes[1], AxisMap::kSqrt, profile.axes.alphaNodes, 1.0);
  }
  return isAxis(axes[0], AxisMap::kLinear, 8, 1.0) && isAxis(axes[1], AxisMap::kLinear, 8, 1.0) &&
         isAxis(axes[2], AxisMap::kLinear, 8, kHalfPi) && isAxis(axes[3], AxisMap::kLinear, 8, kHalfPi);
}

std::string fitCommand(const Profile& profile) {
  if (!profile.axes.isotropic) return "ltcfit fit aniso --size 8x8x8x8 -o table.json";
  return fmt::format("ltcfit fit iso --size {}x{} --axes {} -o table.json", profile.axes.thetaNodes,
                     profile.axes.alphaNodes, profile.axes.theta == AxisMap::kLinear ? 2016 : 2017);
}

ExportResult exportProfile(const Table& given, const Profile& profile, bool resample,
                           const std::string& name) {
  const Table table = withAxes(given, profile, resample);
  ExportResult result;
  result.table = table;
  if (profile.name == "anisotropic-2022") {
    result.files = {{name, tableToAnisotropicCHeader(table, "anisomats")}};
    return result;
  }
  if (profile.name != "unity-hdrp") needAmplitudes(table, profile);
  const Precision precision = profile.half ? Precision::kHalf : Precision::kFloat;
  const std::vector<std::string> names(profile.files.begin(), profile.files.end());
  const auto packedAs = [&](const Packing& packing) { return pack(table, packing, precision); };

  PackedTable packed;
  if (profile.name == "three") {
    packed = packedAs(packing2017());
    result.files = {{name, texturesToModule(packed, {"LTC_MAT_1", "LTC_MAT_2"})}};
  } else if (profile.name == "babylon") {
    packed = packedAs(packing2017());
    std::string bytes;
    for (std::size_t i = 0; i < table.nodeCount(); ++i) {
      for (const Image& image : packed.images) {
        const auto texel = image.values.begin() + static_cast<std::ptrdiff_t>(i * 4);
        appendValues(bytes, std::vector<float>(texel, texel + 4), precision);
      }
    }
    result.files = toRawFiles(packed, std::move(bytes), name, kBabylonContainer);
  } else if (profile.name == "playcanvas") {
    packed = packedAs(packing2017());
    std::string bytes;
    append(bytes, std::int16_t{0});
    append(bytes, std::int16_t{1});
    for (const Image& image : packed.images) appendValues(bytes, image.values, precision);
    result.files = toRawFiles(packed, std::move(bytes), name, kPlayCanvasContainer);
    result.warnings = playCanvasWarnings(packed);
  } else if (profile.name == "bevy") {
    packed = packedAs(packing2017());
    result.files = toKtx2Files(packed, Ktx2Compression::kZstd, name);
  } else if (profile.name == "eevee") {
    packed = packedAs(packingOfBlender());
    result.files = {{name, texturesToBlender(packed)}};
  } else if (profile.name == "unreal") {
    packed = packedAs(packingOfUnreal());
    result.files = {{name, texturesToUnreal(packed)}};
  } else if (profile.name == "unity-hdrp") {
    packed = packedAs(findLayout("hdrp")->packing);
    result.files = {{name, texturesToUnity(packed)}};
  } else if (profile.name == "o3de") {
    packed = packedAs(findLayout("2016")->packing);
    result.files = toDdsFiles(packed, DdsHeader::kDx10, names);
  } else if (profile.name == "godot") {
    packed = packedAs(findLayout("godot")->packing);
    result.files = toDdsFiles(packed, DdsHeader::kDx10, names);
  } else if (profile.name == "selfshadow-dds") {
    packed = packedAs(packing2017());
    result.files = toDdsFiles(packed, DdsHeader::kLegacy, names);
  } else {
    throw std::logic_error("profile without a writer");
  }
  result.half = std::move(packed.half);
  if (std::optional<std::string> warning = warningOf(result.half)) result.warnings.push_back(*warning);
  return result;
}

}  // namespace ltcfit
