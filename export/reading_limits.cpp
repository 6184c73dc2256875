#include "export/reading_limits.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "base/angles.h"
#include "export/direction_moments.h"

namespace ltcfit {
namespace {

using NodeIndex = std::vector<std::size_t>;

// One node in so many may break a limit, and always one alone: published tables and quick fits do.
constexpr std::size_t kMostOdd = 16;
constexpr double kMirrorAlpha = 0.05;
constexpr double kRoughAlpha = 0.9;
constexpr double kNormalView = 0.5 * kRadiansPerDegree;
constexpr double kSteepView = 50.0 * kRadiansPerDegree;
constexpr double kWideningView = 70.0 * kRadiansPerDegree;
constexpr double kGrazingView = 80.0 * kRadiansPerDegree;
// Distances of mean directions: those of good tables are within 0.03 of GGX's, that of 2017 within 0.3 at
// grazing views.
constexpr double kDirection = 0.15;
constexpr double kNormalDirection = 0.05;
constexpr double kGrazingDirection = 0.5;
constexpr double kLength = 0.05;
// The norm of 2017 is off by 0.06 at alpha 1, 90 degrees.
constexpr double kNorm = 0.12;
constexpr double kFresnel = 0.1;
constexpr double kRounding = 0.01;

struct Limit {
  std::size_t tried = 0;
  std::size_t broken = 0;
  double worst = 0.0;
  std::string example;
};

// Where a node is: as a texel where the table is a texture.
std::string texelOf(const Table& table, const NodeIndex& node) {
  const LobeParameters p = table.parameters(node);
  if (table.isIsotropic())
    return fmt::format("texel y {}, x {} (theta {:.1f} degrees, alpha {:.3g})", node[0], node[1],
                       p.theta * kDegreesPerRadian, p.alphaX);
  std::string place;
  for (std::size_t a = 0; a < node.size(); ++a)
    place += fmt::format("{}{}[{}]", a == 0 ? "" : ", ", table.info().axes[a].name, node[a]);
  return place;
}

class LimitChecks {
 public:
  explicit LimitChecks(const Table& table) : table_(table) {}

  // `value` at most `limit`. The component is the one to look at.
  void check(const std::string& name, double value, double limit, const NodeIndex& node,
             const std::string& component, const std::string& found) {
    Limit& l = limits_[name];
    ++l.tried;
    if (value <= limit) return;
    ++l.broken;
    const double excess = std::isnan(value) ? 1e300 : value - limit;
    if (excess <= l.worst) return;
    l.worst = excess;
    l.example = fmt::format("{}, {}: {}", texelOf(table_, node), component, found);
  }

  // The third column of M directs the lobe: the component is of that.
  void checkDirection(const std::string& name, const Eigen::Vector3d& mean, const Eigen::Vector3d& expected,
                      double limit, const NodeIndex& node) {
    Eigen::Index row = 0;
    (mean - expected).cwiseAbs().maxCoeff(&row);
    const char axis = "xyz"[row];
    check(name, (mean - expected).norm(), limit, node, fmt::format("m{}2 of M", row),
          fmt::format("mean direction of the lobe, {} = {:.2f}; of GGX {:.2f}", axis, mean[row],
                      expected[row]));
  }

  std::vector<std::string> broken() const {
    std::vector<std::string> out;
    for (const auto& [name, l] : limits_) {
      if (l.broken > 1 && l.broken * kMostOdd >= l.tried)
        out.push_back(
            fmt::format("{}: not at {} of {} nodes, worst at {}", name, l.broken, l.tried, l.example));
    }
    return out;
  }

 private:
  const Table& table_;
  std::map<std::string, Limit> limits_;
};

void checkLobe(LimitChecks& checks, const NodeIndex& node, const LobeParameters& p,
               const DirectionMoments& lobe, const DirectionMoments& ggx) {
  if (p.alphaX <= kMirrorAlpha && p.theta < kGrazingView)
    checks.checkDirection("lobes of least alpha point to the mirror direction", lobe.mean, ggx.mean,
                          kDirection, node);
  if (p.theta <= kNormalView)
    checks.checkDirection("lobes of the normal view point to the normal", {lobe.mean.x(), lobe.mean.y(), 0.0},
                          Eigen::Vector3d::Zero(), kNormalDirection, node);
  if (p.alphaY >= kRoughAlpha && p.theta <= kSteepView)
    checks.checkDirection("lobes of the largest alpha are nearly the cosine's", lobe.mean, ggx.mean,
                          kDirection, node);
  if (p.theta >= kGrazingView && p.alphaX > kMirrorAlpha)
    checks.checkDirection("lobes of grazing views lean away from the view", lobe.mean, ggx.mean,
                          kGrazingDirection, node);
}

void checkAmplitudes(LimitChecks& checks, const NodeIndex& node, const LobeParameters& p,
                     const TableEntry& entry, const GgxMoments& ggx) {
  if (entry.norm) {
    const double v = *entry.norm;
    const std::string found = fmt::format("{:.3f}, GGX's {:.3f}", v, ggx.norm);
    checks.check("norms are in (0, 1]", v > 0.0 ? v : INFINITY, 1.0 + kRounding, node, "norm", found);
    checks.check(p.theta >= kGrazingView ? "norms go to 1 at 90 degrees" : "norms are near GGX's",
                 std::abs(v - ggx.norm), kNorm, node, "norm", found);
  }
  if (entry.fresnel) {
    const double v = *entry.fresnel;
    const std::string found = fmt::format("{:.3f}, GGX's {:.3f}", v, ggx.fresnel);
    checks.check("Fresnel terms are in 0..norm", v >= -kRounding ? v : INFINITY,
                 entry.norm.value_or(1.0) + kRounding, node, "fresnel", found);
    checks.check("Fresnel terms are near GGX's", std::abs(v - ggx.fresnel), kFresnel, node, "fresnel", found);
  }
}

}  // namespace

std::vector<std::string> brokenLimits(const Table& table, const std::vector<NodeIndex>& nodes) {
  LimitChecks checks(table);
  const std::size_t alphaAxis = table.isIsotropic() ? 1 : 0;
  // of the last node seen at the same place on the other axes: its mean direction's length
  std::map<NodeIndex, double> lengths;
  for (const NodeIndex& node : nodes) {
    const LobeParameters p = table.parameters(node);
    const TableEntry entry = table.entry(node);
    const DirectionMoments lobe = ltcMoments(entry.m);
    const GgxMoments ggx = ggxMoments(p);
    checkLobe(checks, node, p, lobe, ggx.lobe);
    checkAmplitudes(checks, node, p, entry, ggx);
    if (p.theta > kWideningView) continue;
    NodeIndex place = node;
    place[alphaAxis] = 0;
    const auto [previous, isFirst] = lengths.try_emplace(place, lobe.mean.norm());
    if (!isFirst) {
      checks.check("lobes widen with alpha", lobe.mean.norm() - previous->second, kLength, node,
                   "m00 and m11",
                   fmt::format("mean direction of length {:.2f}, before it {:.2f}", lobe.mean.norm(),
                               previous->second));
      previous->second = lobe.mean.norm();
    }
  }
  return checks.broken();
}

}  // namespace ltcfit
