// Benchmarks of the kernels and of the whole fit, with the error reached next to the time.
// Run: build/tests/ltcfit_bench --benchmark_repetitions=5 --benchmark_report_aggregates_only=true
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>

#include "fit/entry_fit.h"
#include "fit/isotropic_table_fit.h"
#include "fit/l3_objective.h"
#include "fit/lobe_shape.h"
#include "ggx/ggx_lobe.h"
#include "ggx/polygon_integral.h"
#include "report/metrics.h"

namespace ltcfit {
namespace {

const GgxLobe& lobe() {
  static const GgxLobe instance(viewDirection(1.1, 0.0), {0.2, 0.2});
  return instance;
}

Eigen::Matrix3d startMatrix() {
  const LobeMoments moments = computeMoments(lobe());
  return matrixOfShape(measureLobeShape(lobe(), moments.mean), moments.mean);
}

void sampleLobe(benchmark::State& state) {
  const R2Sequence points(1);
  std::uint64_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(lobe().sample(points(i++)));
}
BENCHMARK(sampleLobe);

void objective(benchmark::State& state) {
  const L3Objective cost(lobe(), 0.9, static_cast<int>(state.range(0)), 1);
  const L3Objective reference(lobe(), 0.9, 1 << 18, 99);
  const Eigen::Matrix3d m = startMatrix();
  for (auto _ : state) benchmark::DoNotOptimize(cost(m));
  state.counters["relative_error"] = std::abs(cost(m) / reference(m) - 1.0);
}
BENCHMARK(objective)->Arg(256)->Arg(1024)->Arg(4096);

void moments(benchmark::State& state) {
  const double tolerance = 1.0 / static_cast<double>(state.range(0));
  const double exact = computeMoments(lobe(), {1e-10}).albedo;
  for (auto _ : state) benchmark::DoNotOptimize(computeMoments(lobe(), {tolerance}));
  state.counters["albedo_error"] = std::abs(computeMoments(lobe(), {tolerance}).albedo - exact);
}
BENCHMARK(moments)->Arg(100000)->Arg(2000000);

void trueLightIntegral(benchmark::State& state) {
  Random random(1);
  const Quad quad = randomLight(0.25, random);
  for (auto _ : state) benchmark::DoNotOptimize(integrateLobeOverPolygon(lobe(), quad));
}
BENCHMARK(trueLightIntegral);

void fitEntry(benchmark::State& state) {
  EntryFitOptions options;
  options.samples = static_cast<int>(state.range(0));
  const LobeMoments m = computeMoments(lobe());
  const Eigen::Matrix3d start = startMatrix();
  EntryFit fit;
  for (auto _ : state) fit = fitIsotropicEntry(lobe(), m, start, options);
  const EntryMetrics metrics = MetricTarget(lobe(), {}).evaluate(Ltc(fit.m));
  state.counters["L3"] = metrics.get(Metric::kL3);
  state.counters["SW1"] = metrics.get(Metric::kSw1);
}
BENCHMARK(fitEntry)->Arg(256)->Arg(1024)->Arg(4096)->Unit(benchmark::kMillisecond);

void fitTable(benchmark::State& state) {
  IsotropicFitOptions options;
  options.table.thetaNodes = options.table.alphaNodes = 16;
  options.threads = static_cast<int>(state.range(0));
  double error = 0.0;
  for (auto _ : state) {
    const IsotropicFitResult r = fitIsotropicTable(options);
    error = 0.0;
    for (const EntryReport& e : r.reports) error += e.fit.relativeL3 / static_cast<double>(r.reports.size());
  }
  state.counters["relative_L3"] = error;
}
BENCHMARK(fitTable)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace ltcfit
