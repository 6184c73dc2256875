// Benchmarks of the kernels and of the whole fit, with the error reached next to the time.
// Run: build/tests/ltcfit_bench --benchmark_repetitions=5 --benchmark_report_aggregates_only=true
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>

#include "fit/entry_fit.h"
#include "fit/isotropic_table_fit.h"
#include "fit/l3_objective.h"
#include "fit/lobe_shape.h"
#include "fit/sliced_wasserstein.h"
#include "fit/sliced_wasserstein_fit.h"
#include "fit/sorted_projections.h"
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

// 2048 projections with their indices: Highway's vqsort (0) against std::sort on the same packed keys (1).
// Other values each time, so that no branch predictor learns them.
void sortProjections(benchmark::State& state) {
  Random random(1);
  std::vector<double> values(64 * 2048);
  for (double& v : values) v = random.normal();
  std::vector<std::uint64_t> keys(2048);
  ProjectionSorter sorter;
  std::size_t turn = 0;
  for (auto _ : state) {
    const double* const v = values.data() + 2048 * (turn++ % 64);
    if (state.range(0) == 0) {
      benchmark::DoNotOptimize(sorter.order({v, keys.size()}, 0.0));
    } else {
      for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(v[i]));
        keys[i] = (std::uint64_t{(bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u} << 32) | i;
      }
      std::sort(keys.begin(), keys.end());
      benchmark::DoNotOptimize(keys.data());
    }
  }
}
BENCHMARK(sortProjections)->Arg(0)->Arg(1);

// Loss and gradient of 2048 samples on 64 slices: by sorting (0), by cells (1); the counter is the loss.
void slicedLoss(benchmark::State& state) {
  const LobeSamples target = weightedSamples(lobe(), 2048, 1);
  const LobeSamples cosine = cosineSamples(static_cast<int>(target.directions.size()), 2);
  const std::vector<Eigen::Vector3d> slices = familySlices(MatrixFamily::kGeneral, 64);
  const Eigen::Matrix3d m = startMatrix();
  SlicedWasserstein sorted;
  sorted.setTarget(target.directions, slices);
  ProjectedCdfLoss cells(target, m, cosine, slices);
  Eigen::Matrix3d gradient;
  double loss = 0.0;
  for (auto _ : state)
    loss = state.range(0) == 0 ? sorted.evaluate(m, cosine.directions, &gradient) : cells(m, &gradient);
  state.counters["loss"] = loss;
}
BENCHMARK(slicedLoss)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

// One general lobe from cold, by preset, with SW1 on unseen samples.
void fitSliced(benchmark::State& state) {
  static const std::array<const char*, 3> kPresets{"fast", "standard", "fine"};
  const GgxLobe target(viewDirection(1.1, 0.5), {0.5, 0.15});
  const SlicedWassersteinFitOptions options =
      slicedWassersteinPreset(kPresets[static_cast<std::size_t>(state.range(0))]);
  SlicedWassersteinFit fit;
  for (auto _ : state) {
    const SlicedWassersteinTarget t = makeTarget(target, MatrixFamily::kGeneral, options);
    ProjectedCdfLoss loss = makeLoss(t, options.levels.back(), options.seed);
    fit = fitSlicedWasserstein(t, t.start, options, loss);
  }
  const LobeSamples unseen = weightedSamples(target, 65536, 99);
  ProjectedCdfLoss judge(unseen, fit.m, cosineSamples(32768, 98), familySlices(MatrixFamily::kGeneral, 401));
  state.counters["SW1"] = judge(fit.m, nullptr);
  state.SetLabel(kPresets[static_cast<std::size_t>(state.range(0))]);
}
BENCHMARK(fitSliced)->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

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
