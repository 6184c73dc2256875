#include "fit/lookup_loss.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "fit/moment_start.h"
#include "fit/sliced_wasserstein_fit.h"
#include "fit/table_plan.h"
#include "fit/target_lobe.h"
#include "ggx/random.h"
#include "ltc/ltc.h"
#include "ltc/polygon.h"

namespace ltcfit {

using Eigen::Matrix3d;
using Eigen::RowVector3d;
using Eigen::Vector3d;
using Vector9d = Eigen::Matrix<double, 9, 1>;

namespace {

// As in fitSlicedWasserstein.
constexpr double kNarrow = 0.01;
constexpr int kNarrowFactor = 8;
// Of the direct fits, which only give scales and the lights' places.
constexpr SlicedWassersteinLevel kDirect{.samples = 512, .slices = 24, .targetSamples = 2048};

// Errors of a look-up that is no LTC, and draws nothing.
constexpr LookUpErrors kMissed{1.0, 1.0, 1.0};

Vector9d rowByRow(const Matrix3d& m) {
  Vector9d out;
  for (Eigen::Index k = 0; k < 9; ++k) out[k] = m(k / 3, k % 3);
  return out;
}

// As those of the metric form.
std::vector<IntegratedLight> quadsAbout(const Vector3d& mean, double spread, const ContourIntegrator& truth,
                                        double albedo, int count, Random& random) {
  std::vector<IntegratedLight> out;
  const double scale = 1.5 * spread;
  for (int i = 0; i < count; ++i) {
    const double x = scale * random.normal();
    const double y = scale * random.normal();
    const double halfX = scale * std::exp(0.7 * random.normal());
    const double halfY = scale * std::exp(0.7 * random.normal());
    const Quad quad =
        facingRectangle(mean.normalized(), {x, y}, {halfX, halfY}, 2.0 * std::numbers::pi * random.uniform());
    out.push_back({quad, truth.integrate(quad).value / albedo, 1.0});
  }
  return out;
}

double rootMeanSquare(const Ltc& ltc, const std::vector<IntegratedLight>& lights) {
  double squares = 0.0;
  for (const IntegratedLight& l : lights) {
    const double r = l.weight * (ltcPolygonIntegral(ltc, l.quad) - l.integral);
    squares += r * r;
  }
  return std::sqrt(squares / static_cast<double>(lights.size()));
}

// The root is concave: the quadratic of the squares, scaled to touch, lies above it.
double rootMeanSquare(const Ltc& ltc, const std::vector<IntegratedLight>& lights, LossDerivatives* out) {
  out->gradient.setZero();
  out->curvature.setZero();
  double squares = 0.0;
  for (const IntegratedLight& l : lights) {
    Matrix3d gradient;
    const double r = l.weight * (ltcPolygonIntegral(ltc, l.quad, &gradient) - l.integral);
    const Vector9d row = l.weight * rowByRow(gradient);
    squares += r * r;
    out->gradient += r * row;
    out->curvature.selfadjointView<Eigen::Lower>().rankUpdate(row);
  }
  out->curvature.triangularView<Eigen::StrictlyUpper>() = out->curvature.transpose().eval();
  const double n = static_cast<double>(lights.size());
  const double root = std::sqrt(squares / n);
  const double scale = root > 0.0 ? 1.0 / (n * root) : 0.0;
  out->gradient *= scale;
  out->curvature *= scale;
  return root;
}

// Mass below the horizon, sin(psi / 2)^2: the squared length of v.xy / (2 |v| cos(psi / 2)), v row 2 of M and
// psi its angle to the normal.
double massBelow(const Matrix3d& m, LossDerivatives* out) {
  const RowVector3d v = m.row(2);
  const double length = v.norm();
  const double scale = 1.0 / std::sqrt(2.0 * length * (length + v.z()));
  const double x = scale * v.x();
  const double y = scale * v.y();
  Vector9d jx;
  Vector9d jy;
  for (Eigen::Index k = 0; k < 9; ++k) {
    RowVector3d dv = RowVector3d::Zero();
    dv[k % 3] = v[k / 3];
    const double dl = v.dot(dv) / length;
    const double ds = -0.5 * scale * (dl / length + (dl + dv.z()) / (length + v.z()));
    jx[k] = scale * dv.x() + ds * v.x();
    jy[k] = scale * dv.y() + ds * v.y();
  }
  out->gradient = 2.0 * (x * jx + y * jy);
  out->curvature = 2.0 * (jx * jx.transpose() + jy * jy.transpose());
  return x * x + y * y;
}

}  // namespace

bool LookUpLossOptions::isValid(std::string* error) const {
  const auto check = [&](bool ok, const std::string& message) {
    if (!ok) *error = message;
    return ok;
  };
  return check(slices >= 4 && slices <= 1024,
               "slices = " + std::to_string(slices) + ", must be in 4..1024") &&
         check(targetSamples >= kDirect.targetSamples && targetSamples <= 1 << 20,
               "target samples = " + std::to_string(targetSamples) + ", must be in 2048..1048576") &&
         check(samples >= 16 && samples <= 65536,
               "samples = " + std::to_string(samples) + ", must be in 16..65536") &&
         check(quads >= 16 && quads <= 65536,
               "quads = " + std::to_string(quads) + ", must be in 16..65536") &&
         check(leakWeight >= 0.0 && leakWeight <= 100.0,
               "leak weight " + std::to_string(leakWeight) + ", must be in 0..100") &&
         lights.isValid(error);
}

LookUpSamples::LookUpSamples(const LookUpLossOptions& o)
    : few_(cosineSamples(o.samples, mixSeed(o.lights.seed, 31))),
      many_(cosineSamples(kNarrowFactor * o.samples, mixSeed(o.lights.seed, 31))) {}

LookUpLoss::LookUpLoss(const LobeParameters& parameters, std::string_view brdf,
                       const LookUpLossOptions& options, std::uint64_t seed, LookUpSamples& samples)
    : parameters_(parameters), leakWeight_(options.leakWeight) {
  const std::unique_ptr<Lobe> lobe = makeTargetLobe(brdf, parameters);
  const ContourIntegrator truth(*lobe);
  albedo_ = truth.hemisphere();
  SlicedWassersteinTarget target{weightedSamples(*lobe, options.targetSamples, mixSeed(seed, 1)),
                                 Matrix3d::Identity(), familyOf(parameters)};
  target.start = projectOnFamily(momentStart(target.samples), target.family);
  const Vector3d mean = target.samples.mean();
  spread_ = std::acos(std::min(1.0, mean.norm()));
  narrow_ = target.start.leftCols<2>().norm() < kNarrow * target.start.col(2).norm();
  SlicedWassersteinFitOptions quick;
  quick.levels = {kDirect};
  ProjectedCdfLoss directLoss = makeLoss(target, kDirect, quick.seed);
  const Matrix3d direct = fitSlicedWasserstein(target, target.start, quick, directLoss).m;

  Random random(mixSeed(seed, 2));
  std::vector<Vector3d> slices = familySlices(MatrixFamily::kGeneral, options.slices);
  const Eigen::AngleAxisd turn(2.0 * std::numbers::pi * random.uniform(), Vector3d::UnitZ());
  for (Vector3d& w : slices) w = turn * w;
  projected_.emplace_back(target.samples, target.start, slices);
  PolygonLightOptions lights = options.lights;
  lights.seed = mixSeed(seed, 3);
  lights_ = makePolygonLights(truth, albedo_, direct, lights).lights;
  quads_ = quadsAbout(mean, spread_, truth, albedo_, options.quads, random);
  direct_ = errors(direct, samples);
}

bool LookUpLoss::isLtc(const Matrix3d& m) {
  return m.allFinite() && m.determinant() != 0.0 && m.inverse().allFinite() &&
         m.row(2).norm() + m(2, 2) > 0.0;
}

LookUpErrors LookUpLoss::errors(const Matrix3d& m, LookUpSamples& samples) const {
  const Ltc ltc(m);
  return {samples.of(narrow_).loss(projected_[0], m, static_cast<Matrix3d*>(nullptr)),
          rootMeanSquare(ltc, quads_), albedo_ * rootMeanSquare(ltc, lights_)};
}

double LookUpLoss::operator()(const Matrix3d& m, LookUpSamples& samples, LossDerivatives* derivatives) const {
  if (!isLtc(m)) {
    if (derivatives != nullptr) {
      derivatives->gradient.setZero();
      derivatives->curvature.setZero();
    }
    return weights_.sw * kMissed.sw + weights_.form * kMissed.form + weights_.light * kMissed.light;
  }
  const double leak = weights_.light * albedo_ * 0.5 * leakWeight_;
  const Ltc ltc(m);
  if (derivatives == nullptr) {
    const LookUpErrors e = errors(m, samples);
    return weights_.sw * e.sw + weights_.form * e.form + weights_.light * e.light +
           leak * ltc.massBelowHorizon();
  }
  ProjectedCosine::Derivatives slices;
  double value = weights_.sw * samples.of(narrow_).loss(projected_[0], m, &slices);
  derivatives->gradient = weights_.sw * slices.gradient;
  derivatives->curvature = weights_.sw * slices.curvature;
  LossDerivatives part;
  const auto add = [&](double weight, double loss) {
    value += weight * loss;
    derivatives->gradient += weight * part.gradient;
    derivatives->curvature += weight * part.curvature;
  };
  add(weights_.form, rootMeanSquare(ltc, quads_, &part));
  add(weights_.light * albedo_, rootMeanSquare(ltc, lights_, &part));
  add(leak, massBelow(m, &part));
  return value;
}

}  // namespace ltcfit
