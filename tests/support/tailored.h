// Tables as they are made for one scene: sub-ranges, warps, axes of one node, channels left out. Interpolated
// from those in data/, so that they are smooth.
#pragma once

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "export/packing.h"
#include "export/read_table.h"
#include "fit/node_placement.h"
#include "ltc/resample.h"

namespace ltcfit::test {

struct Tailored {
  std::string name;
  Table table;  ///< as packingLean stores it: what shaders interpolate
};

inline Table withoutChannels(const Table& table, const std::vector<std::string>& left) {
  TableInfo info = table.info();
  info.channels.clear();
  std::vector<std::size_t> kept;
  for (std::size_t c = 0; c < table.channelCount(); ++c) {
    const std::string& channel = table.info().channels[c];
    if (std::find(left.begin(), left.end(), channel) != left.end()) continue;
    info.channels.push_back(channel);
    kept.push_back(c);
  }
  std::vector<float> data;
  for (std::size_t i = 0; i < table.nodeCount(); ++i)
    for (std::size_t c : kept) data.push_back(table.data()[i * table.channelCount() + c]);
  return {std::move(info), std::move(data)};
}

inline Table asLean(const Table& table) {
  return unpack(pack(table, packingLean(table.info()), Precision::kFloat));
}

inline Tailored tailored(const std::string& name, std::vector<Axis> axes,
                         const std::vector<std::string>& leftOut = {}) {
  const std::string file = axes.size() == 2 ? "/ltc_iso.json" : "/ltc_aniso.json";
  const Table full = asLean(readTable(LTCFIT_DATA_DIR + file));
  return {name, asLean(withoutChannels(resampled(full, std::move(axes)), leftOut))};
}

inline Axis alphaAxis(AxisMap map, std::size_t n, double low, double high, const AxisWarp& warp = {}) {
  return makeAxis("alpha", "1", map, n, low, high, 0.0, warp);
}
inline Axis lambdaAxis(AxisMap map, std::size_t n, double low, double high, const AxisWarp& warp = {}) {
  return makeAxis("lambda", "1", map, n, low, high, 0.0, warp);
}
inline Axis angleAxis(const char* name, AxisMap map, std::size_t n, double low, double high,
                      const AxisWarp& warp = {}) {
  return makeAxis(name, "rad", map, n, low, high, 0.0, warp);
}

/// `fit aniso --axes best --size 5x4x6x3`.
inline std::vector<Axis> bestAxes() {
  const AnisotropicPlacement best = anisotropicPlacement("best");
  return {placedAxis("alpha", best[0], 5), placedAxis("lambda", best[1], 4), placedAxis("theta", best[2], 6),
          placedAxis("phi", best[3], 3)};
}

/// Of every kind of axis and every set of channels one, the two full ones, and one of the best axes.
inline const std::vector<Tailored>& tailoredTables() {
  constexpr AxisMap kLinear = AxisMap::kLinear;
  constexpr AxisMap kSqrt = AxisMap::kSqrt;
  constexpr AxisMap kAngle = AxisMap::kSqrtOneMinusCos;
  constexpr double kRight = 0.5 * std::numbers::pi;
  static const std::vector<Tailored> tables{
      tailored("isoRange", {angleAxis("theta", kAngle, 7, 0.0, 1.3, {-0.3, 0.2}),
                            alphaAxis(kSqrt, 11, 0.09, 0.49, {0.4, -0.2})}),
      tailored("isoRow", {angleAxis("theta", kAngle, 9, 0.0, kRight), singleNodeAxis("alpha", "1", 0.25)},
               {"fresnel"}),
      tailored("isoLinear", {angleAxis("theta", kLinear, 12, 0.1, 1.5), alphaAxis(kLinear, 6, 0.04, 0.8)},
               {"norm", "fresnel"}),
      tailored("isoNode", {singleNodeAxis("theta", "rad", 0.7), singleNodeAxis("alpha", "1", 0.3)}, {"norm"}),
      tailored("anisoRange",
               {alphaAxis(kSqrt, 4, 0.09, 0.6, {0.5, 0.1}), lambdaAxis(kLinear, 3, 0.2, 1.0),
                angleAxis("theta", kAngle, 6, 0.0, 1.4), angleAxis("phi", kLinear, 5, 0.0, kRight)}),
      tailored("anisoOneAlpha",
               {singleNodeAxis("alpha", "1", 0.3), lambdaAxis(kSqrt, 4, 0.1, 0.9, {-0.4, 0.0}),
                angleAxis("theta", kLinear, 5, 0.0, kRight, {-0.3, -0.2}),
                angleAxis("phi", kAngle, 4, 0.0, kRight)},
               {"fresnel"}),
      tailored(
          "anisoOneLambda",
          {alphaAxis(kLinear, 5, 0.1, 0.9), singleNodeAxis("lambda", "1", 0.5),
           angleAxis("theta", kLinear, 6, 0.2, 1.4), angleAxis("phi", kLinear, 3, 0.0, kRight, {0.1, 0.3})},
          {"norm"}),
      tailored("anisoTheta",
               {singleNodeAxis("alpha", "1", 0.4), singleNodeAxis("lambda", "1", 0.6),
                angleAxis("theta", kAngle, 6, 0.0, 1.3), singleNodeAxis("phi", "rad", 0.4)},
               {"norm", "fresnel"}),
      tailored("anisoPair", {alphaAxis(kLinear, 2, 0.2, 0.3), lambdaAxis(kLinear, 2, 0.5, 0.7),
                             singleNodeAxis("theta", "rad", 0.6), singleNodeAxis("phi", "rad", 0.4)}),
      {"isoFull", asLean(readTable(LTCFIT_DATA_DIR "/ltc_iso.json"))},
      {"anisoFull", asLean(readTable(LTCFIT_DATA_DIR "/ltc_aniso.json"))},
      tailored("anisoBest", bestAxes())};
  return tables;
}

inline const Table& tailoredTable(const std::string& name) {
  const auto& tables = tailoredTables();
  return std::find_if(tables.begin(), tables.end(), [&](const Tailored& t) { return t.name == name; })->table;
}

}  // namespace ltcfit::test
