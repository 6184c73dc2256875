#include "app/half_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>

#include "base/angles.h"
#include "fit/target_lobe.h"
#include "report/metrics.h"

namespace ltcfit::app {
namespace {

// SW1 of the lobe's LTC in float32 and in halves.
std::string nodeLine(const Table& table, const HalfNode& node) {
  const LobeParameters p = table.parameters(table.node(node.node));
  MetricOptions options;
  options.quads = 1;
  options.lights = 1;
  const std::unique_ptr<Lobe> lobe = makeTargetLobe(table.info().brdf, p);
  const MetricTarget target(*lobe, options);
  return fmt::format("  {:>10.6g} {:>10.6g} {:>9.4f} {:>9.4f} {:>12.2e} {:>10.4f} {:>11.3e} {:>11.3e}{}\n",
                     p.alphaX, p.alphaY, p.theta * kDegreesPerRadian, p.phi * kDegreesPerRadian, node.shift,
                     100.0 * node.detError, target.sw1(Ltc(table.entry(table.node(node.node)).m)),
                     target.sw1(Ltc(node.m)), node.constrained ? "  bounded" : "");
}

}  // namespace

std::string halfSummary(const Table& table, const HalfReport& report, int worst) {
  if (report.nodes.empty()) return {};
  std::string out = fmt::format(
      "half: at {} of {} nodes not the nearest halves, at {} bounded (normal diagonal, determinant); largest "
      "lobe shift {:.2e} rad,\n      ",
      report.moved, report.nodes.size(), report.constrained, report.largestShift);
  if (std::isfinite(report.alphaFloor)) {
    fmt::format_to(std::back_inserter(out),
                   "determinant error {:.2f} % from alpha {:.4g} (roughness {:.3f}) on{}",
                   100.0 * report.largestDetError, report.alphaFloor, std::sqrt(report.alphaFloor),
                   report.beyond > 0 ? ", " : "");
  }
  if (report.beyond > 0)
    fmt::format_to(std::back_inserter(out), "determinant error above 1 % at {} sharper node{}", report.beyond,
                   report.beyond == 1 ? "" : "s");
  out += "\n";
  if (worst <= 0) return out;
  std::vector<HalfNode> nodes = report.nodes;
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const HalfNode& a, const HalfNode& b) { return a.shift > b.shift; });
  fmt::format_to(std::back_inserter(out), "  {:>10} {:>10} {:>9} {:>9} {:>12} {:>10} {:>11} {:>11}\n",
                 "alpha_x", "alpha_y", "theta deg", "phi deg", "shift rad", "det err %", "SW1 float",
                 "SW1 half");
  // the same lobe stands at several nodes: at alpha 0 for every lambda
  std::set<std::array<double, 4>> seen;
  for (const HalfNode& node : nodes) {
    if (seen.size() == static_cast<std::size_t>(worst)) break;
    const LobeParameters p = table.parameters(table.node(node.node));
    if (seen.insert({p.alphaX, p.alphaY, p.theta, p.phi}).second) out += nodeLine(table, node);
  }
  return out;
}

}  // namespace ltcfit::app
