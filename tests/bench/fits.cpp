// Whole fits, of one lobe and of small tables, with the options that `ltcfit fit` takes by default. One
// thread: CPU time then does not depend on what else runs.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>

#include "fit/isotropic_table_fit.h"
#include "fit/table_fit.h"
#include "report/score.h"
#include "tests/bench/lobes.h"

namespace ltcfit::bench {
namespace {

// Table, fitter and preset as `ltcfit fit` takes them; one thread.
TableFitOptions fitOptions(TableKind kind, Fitter fitter, const char* preset = "") {
  TableFitOptions options;
  static_cast<LobeFitOptions&>(options) = tableFitPreset(kind, fitter, preset);
  options.threads = 1;
  return options;
}

// What users see, on samples and lights that no fit has seen.
constexpr std::array<Metric, 5> kErrors{Metric::kLightS, Metric::kLightM, Metric::kLightL, Metric::kSw1,
                                        Metric::kBelow};
constexpr std::uint64_t kUnseen = 99;

// One lobe without symmetry, from nothing: moments, true light integrals, fit, alignment.
void fitEntry(benchmark::State& state, Fitter fitter, const char* preset) {
  const TableFitOptions options = fitOptions(TableKind::kAnisotropic, fitter, preset);
  const LobeJob job{{0.5, 0.15, 1.1, 0.5}, MatrixFamily::kGeneral};
  JobResult result;
  for (auto _ : state) result = fitJob(job, "ggx", options);
  static const MetricTarget unseen(anisotropicLobe(), {.lights = 256, .seed = kUnseen});
  const EntryMetrics metrics = unseen.evaluate(Ltc(result.m));
  for (const Metric m : kErrors) state.counters[std::string(metricName(m))] = metrics.get(m);
}
BENCHMARK_CAPTURE(fitEntry, light_fast, Fitter::kLight, "fast")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fitEntry, light_standard, Fitter::kLight, "standard")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fitEntry, sw_fast, Fitter::kSlicedWasserstein, "fast")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fitEntry, sw_standard, Fitter::kSlicedWasserstein, "standard")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fitEntry, l3, Fitter::kL3, "")->Unit(benchmark::kMillisecond);

// Means over 64 nodes, NaN where one of them has no value. Repetitions end with the same table, which is
// scored once.
void countErrors(benchmark::State& state, const TableInfo& info, const std::vector<float>& data) {
  constexpr std::size_t kNodes = 64;
  static std::map<std::vector<float>, Score> known;
  const auto [entry, isNew] = known.try_emplace(data);
  if (isNew) {
    const Table table(info, data);
    ScoreOptions options;
    options.count = kNodes;
    options.metrics.seed = kUnseen;
    entry->second = scoreTables({&table}, options).front();
  }
  for (const Metric m : kErrors) {
    const Summary& summary = entry->second.summary[static_cast<std::size_t>(m)];
    state.counters[std::string(metricName(m))] = summary.count == kNodes ? summary.mean : std::nan("");
  }
}

// l3 with warm starts along the table, as `ltcfit fit iso` does it.
void fitIsotropic16(benchmark::State& state, Fitter fitter) {
  const TableFitOptions options = fitOptions(TableKind::kIsotropic, fitter);
  const IsotropicTableOptions layout{.thetaNodes = 16, .alphaNodes = 16};
  const TablePlan plan = planIsotropicTable(layout);
  std::vector<float> data;
  for (auto _ : state) {
    if (fitter == Fitter::kL3) {
      data = fitIsotropicTable({layout, options.l3, options.threads}).data;
    } else {
      data = fitTable(plan, SymmetryMode::kDuring, options, nullptr).data;
    }
  }
  countErrors(state, plan.info, data);
}
BENCHMARK_CAPTURE(fitIsotropic16, light, Fitter::kLight)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fitIsotropic16, sw, Fitter::kSlicedWasserstein)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fitIsotropic16, l3, Fitter::kL3)->Unit(benchmark::kMillisecond);

void fitAnisotropic4(benchmark::State& state, Fitter fitter) {
  const TableFitOptions options = fitOptions(TableKind::kAnisotropic, fitter);
  const TablePlan plan = planAnisotropicTable(
      {.alphaNodes = 4, .lambdaNodes = 4, .thetaNodes = 4, .phiNodes = 4}, SymmetryMode::kDuring);
  TableFitResult result;
  for (auto _ : state) result = fitTable(plan, SymmetryMode::kDuring, options, nullptr);
  countErrors(state, plan.info, result.data);
}
BENCHMARK_CAPTURE(fitAnisotropic4, light, Fitter::kLight)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fitAnisotropic4, sw, Fitter::kSlicedWasserstein)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ltcfit::bench
