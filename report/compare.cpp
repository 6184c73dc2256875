#include "report/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>

#include "base/parallel_for.h"
#include "base/refusal.h"
#include "report/projections.h"

namespace ltcfit {
namespace {

constexpr int kDirections = 256;
constexpr int kProjections = 16;

bool sameNodes(const Table& a, const Table& b) {
  return std::equal(
      a.info().axes.begin(), a.info().axes.end(), b.info().axes.begin(), b.info().axes.end(),
      [](const Axis& x, const Axis& y) {
        return x.size() == y.size() && x.map == y.map && x.warp == y.warp &&
               (x.map == AxisMap::kNone ? x.values == y.values : x.low == y.low && x.high == y.high);
      });
}

// The middle of the cell that begins at a node, as a shader addresses it; nothing at the upper ends of axes
// of several nodes.
std::optional<LobeParameters> cellCentre(const Table& table, const std::vector<std::size_t>& node) {
  std::array<double, 4> value{};
  for (std::size_t a = 0; a < node.size(); ++a) {
    const Axis& axis = table.info().axes[a];
    if (axis.size() > 1 && node[a] + 1 == axis.size()) return std::nullopt;
    value[a] = axis.size() == 1 ? axis.values[0] : axis.valueFromTexel(static_cast<double>(node[a]) + 0.5);
  }
  if (table.isIsotropic()) return LobeParameters{value[1], value[1], value[0], 0.0};
  return LobeParameters{value[0], value[0] * value[1], value[2], value[3]};
}

bool has(const Table& table, std::string_view channel) {
  const std::vector<std::string>& c = table.info().channels;
  return std::find(c.begin(), c.end(), channel) != c.end();
}

}  // namespace

double lobeDistance(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  static const Eigen::Matrix3Xd cosine = evenCosineDirections(kDirections);
  static const std::vector<Eigen::Vector3d> projections = evenProjections(kProjections);
  return slicedDistance((a * cosine).colwise().normalized(), (b * cosine).colwise().normalized(),
                        projections);
}

TableDifference compareTables(const Table& first, const Table& second) {
  if (first.isIsotropic() != second.isIsotropic())
    throw Refusal("one table is isotropic, the other anisotropic");
  TableDifference out;
  out.sameNodes = sameNodes(first, second);
  out.sameStorage = out.sameNodes && first.info().stores == second.info().stores &&
                    first.info().normalization == second.info().normalization &&
                    first.info().channels == second.info().channels;
  for (const char* channel : {"norm", "fresnel"}) {
    if (has(first, channel) != has(second, channel)) out.oneSided.emplace_back(channel);
  }
  const std::size_t nodes = first.nodeCount();
  if (out.sameStorage) {
    const std::size_t count = first.channelCount();
    for (std::size_t c = 0; c < count; ++c) {
      ChannelDifference difference{first.info().channels[c], 0, 0.0};
      for (std::size_t i = c; i < first.data().size(); i += count) {
        const double d =
            std::abs(static_cast<double>(first.data()[i]) - static_cast<double>(second.data()[i]));
        difference.different += d > 0.0 ? 1 : 0;
        difference.largest = std::max(difference.largest, d);
      }
      out.channels.push_back(difference);
    }
  }
  const double kMissing = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sw1(nodes, kMissing);
  std::vector<double> norm(nodes, kMissing);
  std::vector<double> fresnel(nodes, kMissing);
  parallelFor(nodes, {.chunk = 16}, [&](std::size_t i) {
    const std::vector<std::size_t> node = first.node(i);
    const TableEntry a = first.entry(node);
    const TableEntry b = out.sameNodes ? second.entry(node) : second.fetch(first.parameters(node));
    if (a.invertible && b.invertible) sw1[i] = lobeDistance(a.m, b.m);
    if (a.norm && b.norm) norm[i] = std::abs(*a.norm - *b.norm);
    if (a.fresnel && b.fresnel) fresnel[i] = std::abs(*a.fresnel - *b.fresnel);
  });
  std::vector<double> between(nodes, kMissing);
  parallelFor(nodes, {.chunk = 16}, [&](std::size_t i) {
    const std::optional<LobeParameters> p = cellCentre(first, first.node(i));
    if (!p) return;
    const TableEntry a = first.fetch(*p);
    const TableEntry b = second.fetch(*p);
    if (a.invertible && b.invertible) between[i] = lobeDistance(a.m, b.m);
  });
  double worst = -1.0;
  for (std::size_t i = 0; i < nodes; ++i) {
    out.singular += std::isnan(sw1[i]) ? 1 : 0;
    if (sw1[i] > worst) {
      worst = sw1[i];
      out.worstNode = i;
    }
  }
  out.sw1 = summarize(sw1);
  out.between = summarize(between);
  out.norm = summarize(norm);
  out.fresnel = summarize(fresnel);
  return out;
}

}  // namespace ltcfit
