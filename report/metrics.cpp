#include "report/metrics.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ggx/contour_integral.h"
#include "ltc/polygon.h"

namespace ltcfit {
namespace {

using Eigen::Vector3d;

// True integrals are good to about 1e-6, a hundredth of the smallest error that is told apart with them.
constexpr ContourIntegratorOptions kTrueIntegrals{.azimuths = 128, .radii = 64, .tolerance = 1e-6};

// Uniform directions, evenly spread over the upper half (w and -w give the same distance), turned by the
// seed.
std::vector<Vector3d> evenDirections(int count, std::uint64_t seed) {
  const R2Sequence points(mixSeed(seed, 11));
  std::vector<Vector3d> out;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d u = points(static_cast<std::uint64_t>(i));
    const double phi = 2.0 * std::numbers::pi * u.y();
    const double r = std::sqrt(1.0 - u.x() * u.x());
    out.emplace_back(r * std::cos(phi), r * std::sin(phi), u.x());
  }
  return out;
}

}  // namespace

std::string_view metricName(Metric metric) {
  static constexpr std::array<std::string_view, kMetricCount> kNames{
      "SW1", "SW1rel", "form",  "light_s",      "light_m",       "light_l",   "TV",
      "L3",  "L3cost", "below", "albedo_error", "fresnel_error", "det_error", "interpolation_ratio"};
  return kNames[static_cast<std::size_t>(metric)];
}

MetricTarget::MetricTarget(const Lobe& lobe, const MetricOptions& options)
    : lobe_(lobe), options_(options), moments_(computeMoments(lobe)) {
  // Three streams that no fit uses: fits take the seed itself.
  const R2Sequence lobePoints(mixSeed(options.seed, 7));
  const R2Sequence cosinePoints(mixSeed(options.seed, 8));
  double total = 0.0;
  for (int i = 0; i < options.samples; ++i) {
    const LobeSample s = lobe.sample(lobePoints(static_cast<std::uint64_t>(i)));
    lobeDirections_.push_back(s.wi);
    lobeWeights_.push_back(s.weight);
    total += s.weight;
    cosineDirections_.push_back(sampleCosine(cosinePoints(static_cast<std::uint64_t>(i))));
  }
  for (double& w : lobeWeights_) w /= total;

  projections_ = evenDirections(options.directions, options.seed);
  for (const Vector3d& w : projections_) {
    std::vector<WeightedPosition> sorted;
    for (std::size_t i = 0; i < lobeDirections_.size(); ++i) {
      if (lobeWeights_[i] > 0.0) sorted.push_back({w.dot(lobeDirections_[i]), lobeWeights_[i]});
    }
    sortPositions(sorted);
    sortedTarget_.push_back(std::move(sorted));
  }

  Random random(mixSeed(options.seed, 9));
  const ContourIntegrator truth(lobe, kTrueIntegrals);
  const auto withIntegral = [&](const Quad& quad) {
    return Light{quad, truth.integrate(quad).value / moments_.albedo};
  };
  for (int i = 0; i < options.quads; ++i) quads_.push_back(withIntegral(randomFormQuad(moments_, random)));
  for (std::size_t s = 0; s < kLightSizes.size(); ++s) {
    for (int i = 0; i < options.lights; ++i)
      lights_[s].push_back(withIntegral(randomLight(kLightSizes[s], random)));
  }
}

double MetricTarget::sw1(const Ltc& ltc) const {
  const std::size_t n = cosineDirections_.size();
  std::vector<Vector3d> model(n);
  for (std::size_t i = 0; i < n; ++i) model[i] = ltc.transform(cosineDirections_[i]);
  std::vector<double> f(n);
  double sum = 0.0;
  for (std::size_t k = 0; k < projections_.size(); ++k) {
    for (std::size_t i = 0; i < n; ++i) f[i] = projections_[k].dot(model[i]);
    sortPositions(f);
    sum += cdfDistance(f, sortedTarget_[k]);
  }
  return sum / static_cast<double>(projections_.size());
}

void MetricTarget::compareDensities(const Ltc& ltc, EntryMetrics& out) const {
  // Multiple importance sampling of both, balance heuristic, as in the fit's objective.
  double tv = 0.0;
  double cube = 0.0;
  const auto add = [&](const Vector3d& w) {
    const double f = ltc.density(w);
    const double pdf = f + lobe_.pdf(w);
    if (!(pdf > 0.0)) return;
    const double d = std::abs(f - lobe_.eval(w) / moments_.albedo);
    tv += d / pdf;
    cube += d * d * d / pdf;
  };
  for (const Vector3d& w : lobeDirections_) add(w);
  for (const Vector3d& x : cosineDirections_) add(ltc.transform(x));
  const double n = static_cast<double>(lobeDirections_.size());
  out.set(Metric::kTv, 0.5 * tv / n);
  out.set(Metric::kL3, std::cbrt(cube / n));
  out.set(Metric::kL3Cost, cube / n * std::pow(moments_.albedo, 3));
}

EntryMetrics MetricTarget::evaluate(const Ltc& ltc) const {
  EntryMetrics out;
  const double distance = sw1(ltc);
  out.set(Metric::kSw1, distance);
  out.set(Metric::kSw1Rel, distance / moments_.spread);
  const bool exact = options_.integrator == LightIntegrator::kExact;
  const auto integral = [&](const Quad& quad) {
    return exact ? ltcPolygonIntegral(ltc, quad) : ltcPolygonIntegralByProxySphere(ltc, quad);
  };
  double form = 0.0;
  for (const Light& q : quads_) form += std::abs(integral(q.quad) - q.integral);
  out.set(Metric::kForm, form / static_cast<double>(quads_.size()));
  constexpr std::array<Metric, 3> kLightMetrics{Metric::kLightS, Metric::kLightM, Metric::kLightL};
  for (std::size_t s = 0; s < kLightMetrics.size(); ++s) {
    double sum = 0.0;
    for (const Light& light : lights_[s]) {
      const double d = moments_.albedo * (integral(light.quad) - light.integral);
      sum += d * d;
    }
    out.set(kLightMetrics[s], std::sqrt(sum / static_cast<double>(lights_[s].size())));
  }
  compareDensities(ltc, out);
  out.set(Metric::kBelow, ltc.massBelowHorizon());
  return out;
}

void addEntryErrors(const TableEntry& entry, MatrixStorage stores, const LobeMoments& moments,
                    EntryMetrics& out) {
  if (entry.norm) out.set(Metric::kAlbedoError, std::abs(*entry.norm - moments.albedo));
  if (entry.fresnel) out.set(Metric::kFresnelError, std::abs(*entry.fresnel - moments.fresnel));
  const Eigen::Matrix3f inverse = stores == MatrixStorage::kM
                                      ? Eigen::Matrix3f(entry.m.cast<float>().inverse())
                                      : entry.mInv.cast<float>();
  const double exact = entry.mInv.determinant();
  const double got = inverse.cast<double>().determinant();
  out.set(Metric::kDetError, std::abs(got / exact - 1.0));
}

}  // namespace ltcfit
