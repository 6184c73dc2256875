#include "ltc/resample.h"

#include <cmath>
#include <numbers>
#include <sstream>

#include "base/refusal.h"

namespace ltcfit {
namespace {

// Of angles in files of float32.
constexpr double kRounding = 1e-6;
// How far below 90 degrees the last view of a fit may be: the table of 2017 has 8e-4.
constexpr double kClampedAngle = 1e-3;

// Where a shader finds a node: its texel's coordinate, which at clamped ends is not the value it was fitted
// with.
LobeParameters texelParameters(const TableInfo& info, const std::vector<std::size_t>& node) {
  const auto value = [&](std::size_t a) { return info.axes[a].valueFromTexel(static_cast<double>(node[a])); };
  if (node.size() == 2) return {value(1), value(1), value(0), 0.0};
  return {value(0), value(0) * value(1), value(2), value(3)};
}

void refuseBeyond(const TableInfo& is, const TableInfo& wanted) {
  for (std::size_t a = 0; a < is.axes.size(); ++a) {
    const AxisReach has = reachOf(is, a);
    const AxisReach asked = reachOf(wanted, a);
    if (asked.low >= has.low - kRounding && asked.high <= has.high + kRounding) continue;
    std::ostringstream text;
    text << "axis '" << is.axes[a].name << "' goes from " << has.low << " to " << has.high
         << " in this table, and " << asked.low << " to " << asked.high
         << " is asked for: nothing is known beyond its ends";
    throw Refusal(text.str());
  }
}

}  // namespace

AxisReach reachOf(const TableInfo& info, std::size_t axis) {
  const Axis& a = info.axes[axis];
  const bool angle = a.unit == "rad";
  const double end = angle ? 0.5 * std::numbers::pi : 1.0;
  AxisReach reach{a.low, a.high};
  if (a.map == AxisMap::kNone) {
    reach = {a.values.front(), a.values.back()};
    if (a.size() > 1 && a.name == "alpha" && reach.low <= info.alphaFloor) reach.low = 0.0;
    if (a.size() > 1 && angle && reach.high >= end - kClampedAngle) reach.high = end;
  }
  if (std::abs(reach.low) <= kRounding) reach.low = 0.0;
  if (std::abs(reach.high - end) <= kRounding) reach.high = end;
  return reach;
}

Table resampled(const Table& table, std::vector<Axis> axes) {
  TableInfo info = table.info();
  if (axes.size() != info.axes.size()) throw Refusal("the new axes are of another kind than the table's");
  std::string source;
  for (const Axis& axis : info.axes) {
    if (!source.empty()) source += " x ";
    source += std::to_string(axis.size()) + " " + axis.name + " " + std::string(axisMapName(axis.map));
  }
  info.provenance.options.emplace_back("interpolated_from", source);
  if (!info.provenance.command.empty()) info.provenance.command += ", then interpolated at other nodes";
  info.axes = std::move(axes);
  std::size_t nodes = 1;
  for (const Axis& axis : info.axes) nodes *= axis.size();
  const Table target(info, std::vector<float>(nodes * info.channels.size()));  // checks axes, numbers nodes
  refuseBeyond(table.info(), info);
  std::vector<float> data;
  data.reserve(target.data().size());
  for (std::size_t i = 0; i < nodes; ++i) {
    const TableEntry entry = table.fetch(texelParameters(target.info(), target.node(i)));
    if (!entry.invertible) throw Refusal("node " + std::to_string(i) + " has no inverse");
    const Eigen::Matrix3d m =
        normalized(info.stores == MatrixStorage::kM ? entry.m : entry.mInv, info.normalization);
    for (const std::string& channel : info.channels) {
      if (channel == "norm") {
        data.push_back(static_cast<float>(*entry.norm));
      } else if (channel == "fresnel") {
        data.push_back(static_cast<float>(*entry.fresnel));
      } else {
        data.push_back(static_cast<float>(m(channel[1] - '0', channel[2] - '0')));
      }
    }
  }
  return Table(std::move(info), std::move(data));
}

}  // namespace ltcfit
