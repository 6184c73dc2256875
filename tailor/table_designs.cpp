#include "tailor/table_designs.h"

#include <algorithm>
#include <cmath>

#include "base/parallel_for.h"

namespace ltcfit {
namespace {

// Steps of the warps' search, per coefficient. Errors are flat about the best warp: finer ones do not pay.
constexpr double kWarpStep = 0.2;
constexpr double kSmallestWarpStep = 0.05;

// The warp of least error along the axis: downhill on a grid from even spacing, then on finer ones.
AxisWarp bestWarp(const InterpolationModel& model, std::size_t axis, std::size_t nodes, AxisWarp start) {
  const AxisRange& range = model.ranges()[axis];
  const auto errorOf = [&](const AxisWarp& warp) {
    const InterpolationModel::Shifts shifts = model.shifts(axis, range.axis(nodes, warp));
    const InterpolationModel::Shifts* const one = &shifts;
    return model.error({&one, 1});
  };
  AxisWarp best = start;
  double least = errorOf(best);
  for (double step = kWarpStep; step >= kSmallestWarpStep; step *= 0.5) {
    for (bool moved = true; moved;) {
      moved = false;
      const AxisWarp at = best;
      for (const auto& [da, db] : {std::pair{step, 0.0}, {-step, 0.0}, {0.0, step}, {0.0, -step}}) {
        const AxisWarp tried{at[0] + da, at[1] + db};
        if (!isMonotone(tried)) continue;
        const double error = errorOf(tried);
        // worth the three operations that a warp costs, and rounding
        if (error < least * (1.0 - 1e-3)) {
          least = error;
          best = tried;
          moved = true;
        }
      }
    }
  }
  return best;
}

}  // namespace

std::size_t TableDesign::nodeCount() const {
  std::size_t product = 1;
  for (std::size_t n : nodes) product *= n;
  return product;
}

TableDesigns::TableDesigns(const InterpolationModel& model) : model_(model) {
  const std::size_t most = model.axisCount() == 2 ? kLargestIsotropic : kLargestAnisotropic;
  for (std::size_t a = 0; a < model.axisCount(); ++a) {
    const AxisRange& range = model.ranges()[a];
    std::vector<Choice>& choices = choices_.emplace_back();
    AxisWarp warp{};
    for (std::size_t n = 1; n <= (range.isSingle() ? 1 : most); ++n) {
      if (n > 1) warp = bestWarp(model, a, n, warp);
      Axis axis = range.axis(n, n > 1 ? warp : AxisWarp{});
      InterpolationModel::Shifts shifts = model.shifts(a, axis);
      choices.push_back({std::move(axis), std::move(shifts)});
    }
  }

  std::vector<TableDesign> all;
  std::vector<std::size_t> nodes(model.axisCount(), 1);
  for (bool more = true; more;) {
    all.push_back({nodes, 0.0});
    more = false;
    for (std::size_t a = 0; a < nodes.size() && !more; ++a) {
      more = nodes[a] < choices_[a].size();
      nodes[a] = more ? nodes[a] + 1 : 1;
    }
  }
  parallelFor(all.size(), {.threads = model.threads(), .chunk = 64},
              [&](std::size_t i) { all[i].error = error(all[i].nodes); });
  std::sort(all.begin(), all.end(), [](const TableDesign& a, const TableDesign& b) {
    const std::size_t m = a.nodeCount();
    const std::size_t n = b.nodeCount();
    if (m != n) return m < n;
    return a.error != b.error ? a.error < b.error : a.nodes < b.nodes;
  });
  for (TableDesign& d : all) {
    if (front_.empty() || d.error < front_.back().error) front_.push_back(std::move(d));
  }
}

double TableDesigns::error(const std::vector<std::size_t>& nodes) const {
  std::vector<const InterpolationModel::Shifts*> shifts;
  for (std::size_t a = 0; a < nodes.size(); ++a) shifts.push_back(&choices_[a][nodes[a] - 1].shifts);
  return model_.error(shifts);
}

TableDesign TableDesigns::design(std::vector<std::size_t> nodes) const {
  const double e = error(nodes);
  return {std::move(nodes), e};
}

std::vector<Axis> TableDesigns::axes(const TableDesign& design) const {
  std::vector<Axis> out;
  for (std::size_t a = 0; a < choices_.size(); ++a) out.push_back(choices_[a][design.nodes[a] - 1].axis);
  return out;
}

}  // namespace ltcfit
