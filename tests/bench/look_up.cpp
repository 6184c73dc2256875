// The look-up in tables of the default sizes.
#include <benchmark/benchmark.h>

#include "fit/table_plan.h"
#include "report/points.h"

namespace ltcfit::bench {
namespace {

// Any numbers do: neighbours that differ, matrices that have inverses.
Table madeUpTable(const TablePlan& plan) {
  std::vector<float> data;
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    const float step = 0.001f * static_cast<float>(n % 97);
    for (const std::string& c : plan.info.channels) {
      const bool diagonal = c == "m00" || c == "m11" || c == "m22";
      data.push_back(diagonal ? 1.0f - step : step);
    }
  }
  return Table(plan.info, std::move(data));
}

void fetch(benchmark::State& state, const TablePlan& plan) {
  const Table table = madeUpTable(plan);
  const std::vector<Point> points = makePoints(table, PointSet::kOffGrid, 256, 0.0, 1);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(table.fetch(points[i++ % points.size()].parameters));
}
BENCHMARK_CAPTURE(fetch, isotropic, planIsotropicTable({}));
BENCHMARK_CAPTURE(fetch, anisotropic, planAnisotropicTable({}, SymmetryMode::kDuring));

}  // namespace
}  // namespace ltcfit::bench
