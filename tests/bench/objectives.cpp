// One evaluation of each objective, and the sort that the sliced-Wasserstein distance needs as printed.
// Errors are those of the value, against the same with many more samples or lights.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "fit/l3_objective.h"
#include "fit/light_fit.h"
#include "fit/projected_cdf_loss.h"
#include "fit/sliced_wasserstein.h"
#include "fit/sorted_projections.h"
#include "ltc/ltc.h"
#include "tests/bench/lobes.h"

namespace ltcfit::bench {
namespace {

constexpr MatrixFamily kFamily = MatrixFamily::kGeneral;

void l3Objective(benchmark::State& state) {
  const double albedo = isotropicMoments().albedo;
  const L3Objective cost(isotropicLobe(), albedo, static_cast<int>(state.range(0)), 1);
  static const double exact = L3Objective(isotropicLobe(), albedo, 1 << 18, 99)(isotropicMatrix());
  for (auto _ : state) benchmark::DoNotOptimize(cost(isotropicMatrix()));
  state.counters["relative_error"] = std::abs(cost(isotropicMatrix()) / exact - 1.0);
}
BENCHMARK(l3Objective)->Arg(256)->Arg(1024)->Arg(4096)->Unit(benchmark::kMicrosecond);

// 2048 projections with their indices: Highway's vqsort against std::sort on the same packed keys.
// Other values each time, so that no branch predictor learns them.
enum class Sort { kVqsort, kStd };
void sortProjections(benchmark::State& state, Sort sort) {
  Random random(1);
  std::vector<double> values(64 * 2048);
  for (double& v : values) v = random.normal();
  std::vector<std::uint64_t> keys(2048);
  ProjectionSorter sorter;
  std::size_t turn = 0;
  for (auto _ : state) {
    const double* const v = values.data() + 2048 * (turn++ % 64);
    if (sort == Sort::kVqsort) {
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
BENCHMARK_CAPTURE(sortProjections, vqsort, Sort::kVqsort)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(sortProjections, std, Sort::kStd)->Unit(benchmark::kMicrosecond);

double exactSlicedLoss() {
  ProjectedCdfLoss loss(weightedSamples(anisotropicLobe(), 1 << 17, 99), anisotropicMatrix(),
                        cosineSamples(1 << 17, 98), familySlices(kFamily, 401));
  return loss(anisotropicMatrix(), nullptr);
}

// Loss and gradient of 2048 samples on 64 slices: as printed, by sorting equally likely samples, and by
// cells.
void slicedLossSorting(benchmark::State& state) {
  Random random(1);
  const std::vector<Eigen::Vector3d> target = rejectionSamples(anisotropicLobe(), 2048, random);
  const R2Sequence points(2);
  std::vector<Eigen::Vector3d> cosine;
  for (std::uint64_t i = 0; i < target.size(); ++i) cosine.push_back(sampleCosine(points(i)));
  const std::vector<Eigen::Vector3d> slices = familySlices(kFamily, 64);
  SlicedWasserstein loss;
  loss.setTarget(target, slices);
  Eigen::Matrix3d gradient;
  double value = 0.0;
  for (auto _ : state) value = loss.evaluate(anisotropicMatrix(), cosine, &gradient);
  static const double exact = exactSlicedLoss();
  state.counters["relative_error"] = std::abs(value / exact - 1.0);
}
BENCHMARK(slicedLossSorting)->Unit(benchmark::kMicrosecond);

void slicedLossCells(benchmark::State& state) {
  ProjectedCdfLoss loss(weightedSamples(anisotropicLobe(), 2048, 1), anisotropicMatrix(),
                        cosineSamples(2048, 2), familySlices(kFamily, 64));
  Eigen::Matrix3d gradient;
  double value = 0.0;
  for (auto _ : state) value = loss(anisotropicMatrix(), &gradient);
  static const double exact = exactSlicedLoss();
  state.counters["relative_error"] = std::abs(value / exact - 1.0);
}
BENCHMARK(slicedLossCells)->Unit(benchmark::kMicrosecond);

std::vector<IntegratedLight> lightFamily(int count) {
  const ContourIntegrator truth(anisotropicLobe());
  PolygonLightOptions options;
  options.lights = count;
  return makePolygonLights(truth, anisotropicMoments().albedo, anisotropicMatrix(), options).lights;
}

double rmsError(const std::vector<IntegratedLight>& family) {
  const LightProblem problem{.lights = &family, .family = kFamily};
  return std::sqrt(2.0 * problem.cost(anisotropicMatrix()) / static_cast<double>(family.size()));
}

// Residuals of the light-space fit, and with their Jacobian: 7 parameters.
enum class Derivatives { kNone, kJacobian };
void lightResiduals(benchmark::State& state, Derivatives derivatives) {
  const std::vector<IntegratedLight> family = lightFamily(static_cast<int>(state.range(0)));
  const LightProblem problem{.lights = &family, .family = kFamily};
  const std::vector<double> p(familyBasis(kFamily).size(), 0.0);
  std::vector<double> residuals(problem.residualCount());
  std::vector<double> jacobian(residuals.size() * p.size());
  double* const into = derivatives == Derivatives::kJacobian ? jacobian.data() : nullptr;
  for (auto _ : state) {
    benchmark::DoNotOptimize(problem.evaluate(anisotropicMatrix(), p.data(), residuals.data(), into));
    benchmark::ClobberMemory();
  }
  static const double exact = rmsError(lightFamily(1 << 15));
  state.counters["relative_error"] = std::abs(rmsError(family) / exact - 1.0);
}
BENCHMARK_CAPTURE(lightResiduals, values, Derivatives::kNone)
    ->Arg(256)
    ->Arg(1024)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lightResiduals, jacobian, Derivatives::kJacobian)
    ->Arg(256)
    ->Arg(1024)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ltcfit::bench
