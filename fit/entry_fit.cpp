#include "fit/entry_fit.h"

#include <cmath>

#include "fit/l3_objective.h"

namespace ltcfit {
namespace {

EntryFit toEntryFit(const OptimizerResult& best, const Eigen::Matrix3d& m, double lobeCube) {
  EntryFit fit;
  fit.m = m;
  fit.startCost = best.startCost;
  fit.cost = best.cost;
  fit.relativeL3 = std::cbrt(best.cost / lobeCube);
  fit.evaluations = best.evaluations;
  fit.termination = best.termination;
  return fit;
}

}  // namespace

bool EntryFitOptions::isValid(std::string* error) const {
  if (samples < 16 || samples > 1 << 22) {
    *error = "--samples " + std::to_string(samples) + " must be in [16, 4194304]";
    return false;
  }
  return nelderMead.isValid(error);
}

EntryFit fitIsotropicEntry(const Lobe& lobe, const LobeMoments& moments, const Eigen::Matrix3d& start,
                           const EntryFitOptions& options) {
  const bool normalView = lobe.wo().x() == 0.0;
  const IsotropicParametrization parametrization(options.family, normalView, moments.mean, start);
  const L3Objective objective(lobe, moments.albedo, options.samples, options.seed);
  const OptimizerResult best = minimizeNelderMead(
      [&](std::span<const double> v) { return objective(parametrization.matrix(v)); },
      parametrization.start(), parametrization.steps(options.simplexEdge), options.nelderMead);

  return toEntryFit(best, parametrization.matrix(best.parameters), objective.lobeCube());
}

EntryFit fitL3Entry(const Lobe& lobe, double albedo, MatrixFamily family, const Eigen::Matrix3d& start,
                    const EntryFitOptions& options) {
  const L3Objective objective(lobe, albedo, options.samples, options.seed);
  const std::vector<double> zero(familyBasis(family).size(), 0.0);
  const std::vector<double> steps(zero.size(), options.simplexEdge);
  const OptimizerResult best =
      minimizeNelderMead([&](std::span<const double> p) { return objective(changedBy(start, family, p)); },
                         zero, steps, options.nelderMead);
  return toEntryFit(best, changedBy(start, family, best.parameters), objective.lobeCube());
}

}  // namespace ltcfit
