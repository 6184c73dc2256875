#include "fit/lobe_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "base/refusal.h"
#include "fit/target_lobe.h"
#include "ggx/random.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;

// A light-space fit whose SW1 is so many times that of its start has lost the lobe.
constexpr double kWorstLoss = 1.5;
// DESIGN.md, Leaked light. Isotropic tables have room for less of it: at 0.2 it falls by a tenth for half a
// percent of SW1; for the anisotropic table SW1 comes first.
constexpr double kIsotropicLeakWeight = 0.2;
constexpr double kIsotropicLightLeakWeight = 0.02;
constexpr double kAnisotropicLightLeakWeight = 0.05;
// DESIGN.md, Lights: the largest that do not lose on large lights against sw.
constexpr double kIsotropicSizeExponent = 0.25;
constexpr double kAnisotropicSizeExponent = 0.4;
// What judges the SW1 of light-space fits, for the summary.
constexpr SlicedWassersteinLevel kJudge{.samples = 1024, .slices = 32, .targetSamples = 2048};
// What decides between fits of a lobe that lights do not hold.
constexpr SlicedWassersteinLevel kUnseen{.samples = 4096, .slices = 96, .targetSamples = 32768};

// Fewer slices do for a matrix of the family; a stochastic descent leaves it.
MatrixFamily judgedFamily(MatrixFamily family, Fitter fitter) {
  return fitter == Fitter::kSlicedWassersteinSgd ? MatrixFamily::kGeneral : family;
}

LobeFit fitBySlices(LobeFitTarget& target, const Matrix3d& start, const LobeFitOptions& options) {
  const SlicedWassersteinFit fit = fitSlicedWasserstein(target.samples(), start, options.sw, target.judge());
  return {
      .m = fit.m, .evaluations = fit.evaluations, .termination = fit.termination, .restarted = fit.restarted};
}

}  // namespace

std::string_view fitterName(Fitter fitter) {
  switch (fitter) {
    case Fitter::kSlicedWassersteinSgd:
      return "sw-sgd";
    case Fitter::kL3:
      return "l3";
    case Fitter::kLight:
      return "light";
    case Fitter::kSlicedWasserstein:
      break;
  }
  return "sw";
}

Fitter fitterFromName(std::string_view name) {
  for (const Fitter f :
       {Fitter::kSlicedWasserstein, Fitter::kSlicedWassersteinSgd, Fitter::kL3, Fitter::kLight}) {
    if (name == fitterName(f)) return f;
  }
  throw Refusal("fitter '" + std::string(name) + "' (light, sw, sw-sgd or l3)");
}

bool LobeFitOptions::isValid(std::string* error) const {
  return sw.isValid(error) && sgd.isValid(error) && light.isValid(error) && l3.isValid(error);
}

void LobeFitOptions::setSeed(std::uint64_t seed) {
  sw.seed = sgd.seed = light.lights.seed = l3.seed = seed;
}

std::string_view defaultPreset(TableKind kind, Fitter fitter) {
  if (fitter == Fitter::kL3) return "";
  if (fitter == Fitter::kSlicedWassersteinSgd) return "quick";
  return kind == TableKind::kIsotropic ? "fast" : "standard";
}

LobeFitOptions tableFitPreset(TableKind kind, Fitter fitter, std::string_view preset) {
  const bool iso = kind == TableKind::kIsotropic;
  const std::string_view name = preset.empty() ? defaultPreset(kind, fitter) : preset;
  LobeFitOptions o;
  o.fitter = fitter;
  switch (fitter) {
    case Fitter::kLight:
      o.light = lightFitPreset(name);
      o.light.lights.sizeExponent = iso ? kIsotropicSizeExponent : kAnisotropicSizeExponent;
      o.light.leakWeight = iso ? kIsotropicLightLeakWeight : kAnisotropicLightLeakWeight;
      o.sw.levels = {kJudge};
      break;
    case Fitter::kSlicedWasserstein:
      o.sw = slicedWassersteinPreset(name);
      o.sw.leakWeight = iso ? kIsotropicLeakWeight : 0.0;
      break;
    case Fitter::kSlicedWassersteinSgd:
      if (name != "quick" && name != "paper")
        throw Refusal("preset '" + std::string(name) + "' (quick or paper)");
      if (name == "paper") o.sgd = paperSgdOptions();
      break;
    case Fitter::kL3:
      if (!name.empty()) throw Refusal("l3 has no preset '" + std::string(name) + "'");
      break;
  }
  return o;
}

LobeFitTarget::LobeFitTarget(const LobeJob& job, std::string_view brdf, const LobeFitOptions& options)
    : lobe_(makeTargetLobe(brdf, job.parameters)),
      moments_(computeMoments(*lobe_)),
      family_(job.family),
      samples_(makeTarget(*lobe_, judgedFamily(job.family, options.fitter), options.sw)),
      judgeLevel_(options.sw.levels.back()),
      seed_(options.sw.seed) {}

ProjectedCdfLoss& LobeFitTarget::judge() {
  if (!judge_) judge_.emplace(makeLoss(samples_, judgeLevel_, seed_));
  return *judge_;
}

LobeFit fitLobe(LobeFitTarget& target, const Matrix3d& start, const LobeFitOptions& options) {
  switch (options.fitter) {
    case Fitter::kSlicedWasserstein:
      return fitBySlices(target, start, options);
    case Fitter::kSlicedWassersteinSgd: {
      const SgdResult fit = descendSlicedWasserstein(target.lobe(), start, options.sgd);
      return {.m = fit.m,
              .evaluations = options.sgd.steps,
              .termination = fit.finite ? Termination::kConverged : Termination::kFailure};
    }
    case Fitter::kL3: {
      const EntryFit fit =
          fitL3Entry(target.lobe(), target.moments().albedo, target.family(), start, options.l3);
      return {.m = fit.m, .evaluations = fit.evaluations, .termination = fit.termination};
    }
    case Fitter::kLight:
      break;
  }
  const ContourIntegrator truth(target.lobe());
  const LightTarget lights{truth, target.moments().albedo, target.family(), target.momentStart()};
  const LightFit light = fitLights(lights, start, options.light);
  LobeFit fit{.m = light.m,
              .evaluations = light.evaluations,
              .termination = light.termination,
              .integralError = light.integralError,
              .restarted = light.restarted};
  // Lights that do not hold the lobe: the other fit does, or the start, whichever is best on samples that
  // none has seen (of needles at grazing view the tails make up SW1, and a few thousand samples are
  // overfitted).
  if (light.termination == Termination::kFailure ||
      target.judge()(light.m, nullptr) > kWorstLoss * target.judge()(target.momentStart(), nullptr)) {
    const LobeFit sw = fitBySlices(target, target.momentStart(), options);
    SlicedWassersteinFitOptions unseen;
    unseen.levels = {kUnseen};
    unseen.seed = mixSeed(options.sw.seed, 45);
    ProjectedCdfLoss arbiter =
        makeLoss(makeTarget(target.lobe(), target.family(), unseen), kUnseen, unseen.seed);
    fit.evaluations += sw.evaluations;
    fit.handedOver = true;
    const auto lossOf = [&](const Matrix3d& m) {
      return m.allFinite() && m.determinant() > 0.0 ? arbiter(m, nullptr)
                                                    : std::numeric_limits<double>::infinity();
    };
    const double lightLoss = lossOf(light.m);
    const double swLoss = lossOf(sw.m);
    if (swLoss <= lightLoss) {
      fit.m = sw.m;
      fit.termination = sw.termination;
    }
    if (lossOf(target.momentStart()) < std::min(lightLoss, swLoss)) {
      fit.m = target.momentStart();
      fit.startKept = true;
    }
  }
  return fit;
}

}  // namespace ltcfit
