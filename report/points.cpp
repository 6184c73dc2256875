#include "report/points.h"

#include <algorithm>
#include <array>
#include <string>

#include "base/angles.h"
#include "base/refusal.h"
#include "ggx/random.h"
#include "ltc/resample.h"

namespace ltcfit {
namespace {

struct Interval {
  double low, high;
  double at(double u) const { return low + u * (high - low); }
  /// The part of it that lies in `other`; the end of `other` next to it where none does.
  Interval within(const Interval& other) const {
    return {std::clamp(low, other.low, other.high), std::clamp(high, other.low, other.high)};
  }
};

// What the axes of a table answer for, in the coordinates in which points are drawn.
class Domain {
 public:
  explicit Domain(const Table& table) : info_(table.info()) {}

  Interval mapped(std::size_t axis, AxisMap map) const {
    const AxisReach reach = reachOf(info_, axis);
    // exact at the end, where rounding would move every point
    const double high =
        map == AxisMap::kSqrtOneMinusCos && reach.high == kHalfPi ? 1.0 : mapCoordinate(map, reach.high);
    return {mapCoordinate(map, reach.low), high};
  }
  Interval linear(std::size_t axis, double unit) const {
    const AxisReach reach = reachOf(info_, axis);
    return {reach.low / unit, reach.high / unit};
  }

 private:
  const TableInfo& info_;
};

LobeParameters randomIsotropic(const Domain& domain, PointSet set, Random& random) {
  const bool extreme = set == PointSet::kExtreme;
  const Interval root =
      (extreme ? Interval{0.01, 0.21} : Interval{0.05, 1.0}).within(domain.mapped(1, AxisMap::kSqrt));
  const Interval angle = (extreme ? Interval{0.97, 1.0} : Interval{0.0, 1.0})
                             .within(domain.mapped(0, AxisMap::kSqrtOneMinusCos));
  const double alpha = unmapCoordinate(AxisMap::kSqrt, root.at(random.uniform()));
  const double theta = unmapCoordinate(AxisMap::kSqrtOneMinusCos, angle.at(random.uniform()));
  return {alpha, alpha, theta, 0.0};
}

LobeParameters randomAnisotropic(const Domain& domain, PointSet set, Random& random) {
  const bool extreme = set == PointSet::kExtreme;
  const double alpha = Interval{0.03, 1.0}.within(domain.linear(0, 1.0)).at(random.uniform());
  const double lambda = (extreme ? Interval{0.02, 0.2} : Interval{0.05, 1.0})
                            .within(domain.linear(1, 1.0))
                            .at(random.uniform());
  const double theta = kHalfPi * (extreme ? Interval{0.85, 1.0} : Interval{0.0, 1.0})
                                     .within(domain.linear(2, kHalfPi))
                                     .at(random.uniform());
  const double phi = kHalfPi * Interval{0.0, 1.0}.within(domain.linear(3, kHalfPi)).at(random.uniform());
  return {alpha, alpha * lambda, theta, phi};
}

}  // namespace

std::string_view pointSetName(PointSet set) {
  static constexpr std::array<std::string_view, 3> kNames{"nodes", "off-grid", "extreme"};
  return kNames[static_cast<std::size_t>(set)];
}

PointSet pointSetFromName(std::string_view name) {
  for (PointSet set : {PointSet::kNodes, PointSet::kOffGrid, PointSet::kExtreme}) {
    if (name == pointSetName(set)) return set;
  }
  throw Refusal("unknown point set '" + std::string(name) + "' (nodes, off-grid or extreme)");
}

std::vector<Point> makePoints(const Table& table, PointSet set, std::size_t count, double minAlpha,
                              std::uint64_t seed) {
  Random random(mixSeed(seed, 5));
  const Domain domain(table);
  std::vector<Point> points;
  if (set != PointSet::kNodes) {
    // An interval that lies below minAlpha altogether gives up after a while instead of looping for ever.
    for (std::size_t tries = 0; points.size() < count && tries < 1000 * (count + 1); ++tries) {
      const LobeParameters p =
          table.isIsotropic() ? randomIsotropic(domain, set, random) : randomAnisotropic(domain, set, random);
      if (p.alphaX >= minAlpha) points.push_back({p, std::nullopt});
    }
    return points;
  }
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    const LobeParameters p = table.parameters(table.node(i));
    if (p.alphaX >= minAlpha) points.push_back({p, i});
  }
  if (count == 0 || count >= points.size()) return points;
  // the first `count` of a Fisher-Yates shuffle, back in the table's order
  for (std::size_t i = 0; i < count; ++i) {
    const double left = static_cast<double>(points.size() - i);
    std::swap(points[i], points[i + static_cast<std::size_t>(random.uniform() * left)]);
  }
  points.resize(count);
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.node < b.node; });
  return points;
}

}  // namespace ltcfit
