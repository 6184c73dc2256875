// Sampling, moments, and integrals over polygons.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "fit/lobe_samples.h"
#include "ggx/contour_integral.h"
#include "ltc/ltc.h"
#include "ltc/polygon.h"
#include "tests/bench/lobes.h"

namespace ltcfit::bench {
namespace {

constexpr int kJudged = 4096;  // samples by which a sampler is judged

void sampleLobe(benchmark::State& state) {
  const R2Sequence points(1);
  std::uint64_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(isotropicLobe().sample(points(i++)));
  double albedo = 0.0;
  for (int k = 0; k < kJudged; ++k)
    albedo += isotropicLobe().sample(points(static_cast<std::uint64_t>(k))).weight / kJudged;
  state.counters["albedo_error"] = std::abs(albedo - isotropicMoments().albedo);
}
BENCHMARK(sampleLobe);

void sampleByRejection(benchmark::State& state) {
  std::vector<Eigen::Vector3d> samples;
  for (auto _ : state) {
    Random random(1);
    samples = rejectionSamples(isotropicLobe(), kJudged, random);
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& wi : samples) mean += wi / kJudged;
  state.counters["mean_error"] = (mean - isotropicMoments().mean).norm();
}
BENCHMARK(sampleByRejection)->Unit(benchmark::kMicrosecond);

void sampleLtc(benchmark::State& state) {
  const Ltc ltc(anisotropicMatrix());
  const R2Sequence points(1);
  std::uint64_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(ltc.sample(points(i++)));
  int below = 0;
  for (int k = 0; k < kJudged; ++k) below += ltc.sample(points(static_cast<std::uint64_t>(k))).z() < 0.0;
  state.counters["below_error"] = std::abs(static_cast<double>(below) / kJudged - ltc.massBelowHorizon());
}
BENCHMARK(sampleLtc);

// The argument is one over the tolerance of a cell; the default is 2,000,000.
void moments(benchmark::State& state) {
  static const double exact = computeMoments(isotropicLobe(), {1e-10}).albedo;
  const MomentsOptions options{1.0 / static_cast<double>(state.range(0))};
  for (auto _ : state) benchmark::DoNotOptimize(computeMoments(isotropicLobe(), options));
  state.counters["albedo_error"] = std::abs(computeMoments(isotropicLobe(), options).albedo - exact);
}
BENCHMARK(moments)->Arg(100000)->Arg(2000000)->Unit(benchmark::kMicrosecond);

// The table that a lobe's light integrals come from.
void contourTable(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(ContourIntegrator(anisotropicLobe()));
  static const double exact = ContourIntegrator(anisotropicLobe(), {640, 256, 1e-8}).hemisphere();
  state.counters["albedo_error"] = std::abs(ContourIntegrator(anisotropicLobe()).hemisphere() - exact);
}
BENCHMARK(contourTable)->Unit(benchmark::kMicrosecond);

// The true integral of the lobe over a light.
void lobeOverQuad(benchmark::State& state) {
  const ContourIntegrator lobe(anisotropicLobe());
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(lobe.integrate(lights()[i++ % lights().size()]));
  static const ContourIntegrator exact(anisotropicLobe(), {640, 256, 1e-8});
  double worst = 0.0;
  for (const Quad& quad : lights())
    worst = std::max(worst, std::abs(lobe.integrate(quad).value - exact.integrate(quad).value));
  state.counters["worst_error"] = worst;
}
BENCHMARK(lobeOverQuad);

// Closed forms: no error to give.
void ltcOverQuad(benchmark::State& state) {
  const Ltc ltc(anisotropicMatrix());
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(ltcPolygonIntegral(ltc, lights()[i++ % lights().size()]));
}
BENCHMARK(ltcOverQuad);

void ltcOverQuadGradient(benchmark::State& state) {
  const Ltc ltc(anisotropicMatrix());
  Eigen::Matrix3d gradient;
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(ltcPolygonIntegral(ltc, lights()[i++ % lights().size()], &gradient));
    benchmark::DoNotOptimize(gradient);
  }
}
BENCHMARK(ltcOverQuadGradient);

}  // namespace
}  // namespace ltcfit::bench
