#include "report/lobe_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "base/angles.h"

namespace ltcfit {
namespace {

// A place in the table: values of the axes, isotropic {theta, alpha}, anisotropic {alpha, lambda, theta,
// phi}.
struct Place {
  const char* why;
  std::array<double, 2> isotropic;
  std::array<double, 4> anisotropic;
};
constexpr std::array<Place, 3> kPlaces{{
    {"sharp, grazing view",
     {80.0 * kRadiansPerDegree, 0.05},
     {0.3, 0.15, 80.0 * kRadiansPerDegree, 45.0 * kRadiansPerDegree}},
    {"rough, normal view", {0.0, 1.0}, {1.0, 1.0, 0.0, 0.0}},
    {"medium",
     {60.0 * kRadiansPerDegree, 0.25},
     {0.6, 0.4, 50.0 * kRadiansPerDegree, 45.0 * kRadiansPerDegree}},
}};

std::size_t nearestNode(const Table& table, const Place& place) {
  const std::vector<Axis>& axes = table.info().axes;
  std::size_t flat = 0;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const double value = table.isIsotropic() ? place.isotropic[a] : place.anisotropic[a];
    flat = flat * axes[a].size() + static_cast<std::size_t>(std::lround(axes[a].texelFromValue(value)));
  }
  return flat;
}

}  // namespace

std::vector<ChosenLobe> chooseLobes(const Table& table, const Score& nodes) {
  // a table holds the same lobe at several nodes: at normal view for every phi
  std::vector<ChosenLobe> out;
  std::set<std::array<double, 4>> seen;
  const auto add = [&](std::size_t node, const char* why) {
    if (!table.entry(table.node(node)).invertible) return false;
    const LobeParameters p = table.parameters(table.node(node));
    if (!seen.insert({p.alphaX, p.alphaY, p.theta, p.theta > 0.0 ? p.phi : 0.0}).second) return false;
    out.push_back({node, why});
    return true;
  };
  // node numbers by rising value; ties in the order of the table
  const auto ranked = [&](Metric metric) {
    std::vector<std::size_t> order(nodes.all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto value = [&](std::size_t i) { return nodes.all[i].metrics.get(metric); };
    std::erase_if(order, [&](std::size_t i) {
      const LobeParameters& p = nodes.all[i].parameters;
      return !std::isfinite(value(i)) || std::min(p.alphaX, p.alphaY) < kSharpestPicture;
    });
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return value(a) < value(b); });
    return order;
  };
  const auto addFirst = [&](const auto& order, const char* why) {
    std::any_of(order.begin(), order.end(), [&](std::size_t node) { return add(node, why); });
  };
  const auto addLast = [&](std::vector<std::size_t> order, const char* why) {
    std::reverse(order.begin(), order.end());
    addFirst(order, why);
  };
  std::vector<std::size_t> byDistance = ranked(Metric::kSw1Rel);
  addFirst(byDistance, "least SW1rel, alpha from 0.01");
  addLast(byDistance, "largest SW1rel, alpha from 0.01");
  byDistance.erase(byDistance.begin(),
                   byDistance.begin() + static_cast<std::ptrdiff_t>(byDistance.size() / 2));
  addFirst(byDistance, "median SW1rel, alpha from 0.01");
  addLast(ranked(Metric::kLightM), "largest light_m, alpha from 0.01");
  addLast(ranked(Metric::kBelow), "most light below the horizon, alpha from 0.01");
  for (const Place& place : kPlaces) add(nearestNode(table, place), place.why);
  return out;
}

}  // namespace ltcfit
