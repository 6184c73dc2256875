// The benchmark program. scripts/bench.sh runs it and compares; by hand:
// build/tests/ltcfit_bench --benchmark_repetitions=5 --benchmark_report_aggregates_only=true
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>

namespace {

// What times are divided by before two runs are compared: scalar arithmetic, as a clock of the machine at
// that moment. Changing it makes every kept result useless.
void calibration(benchmark::State& state) {
  std::uint64_t bits = 1;
  double sum = 0.0;
  for (auto _ : state) {
    for (int i = 0; i < 1000; ++i) {
      bits ^= bits << 13;
      bits ^= bits >> 7;
      bits ^= bits << 17;
      const double x = static_cast<double>(bits >> 11) * 0x1p-53;
      sum += std::sqrt(x + 0.25) / (1.0 + x * x);
    }
    benchmark::DoNotOptimize(sum);
  }
}
BENCHMARK(calibration);

}  // namespace

int main(int argc, char** argv) {
#ifdef __clang__
  benchmark::AddCustomContext("compiler", __VERSION__);
#else
  benchmark::AddCustomContext("compiler", "GCC " __VERSION__);
#endif
  benchmark::AddCustomContext("build", LTCFIT_BUILD);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const std::size_t matched = benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return matched > 0 ? 0 : 2;
}
