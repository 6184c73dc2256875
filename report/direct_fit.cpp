#include "report/direct_fit.h"

#include <fmt/format.h>

#include <Eigen/LU>

#include "fit/table_fit.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;

// A fit of the stochastic descent's preset "quick" takes half of this, of "paper" 17; those of all other
// presets take less than one second.
constexpr double kMostSeconds = 1.0;

// CPU seconds of one fit, within a factor of some three: numbers of samples times what one of them takes.
double secondsOf(const LobeFitOptions& o) {
  const auto product = [](double unit, double a, double b) { return unit * a * b; };
  switch (o.fitter) {
    case Fitter::kSlicedWassersteinSgd:
      return o.sgd.steps * product(1.3e-8, o.sgd.samples, o.sgd.slices);
    case Fitter::kL3:
      return product(1e-7, o.l3.samples, o.l3.nelderMead.maxEvaluations);
    case Fitter::kLight:
      return 1e-5 * o.light.lights.lights;
    case Fitter::kSlicedWasserstein:
      break;
  }
  return product(2e-7, o.sw.levels.back().samples, o.sw.levels.back().slices);
}

// The sliced Wasserstein distance of a descent too long for every point is minimised without it; of other
// fitters the effort of a damaged or extreme file is left.
void boundEffort(RecordedFit* recorded) {
  FitRecipe& recipe = recorded->recipe;
  const double seconds = secondsOf(recipe.fit);
  if (seconds <= kMostSeconds) return;
  const Fitter fitter = recipe.fit.fitter;
  const bool descent = fitter == Fitter::kSlicedWassersteinSgd;
  const Fitter instead = descent ? Fitter::kSlicedWasserstein : fitter;
  const std::uint64_t seed = recipe.fit.sw.seed;
  recipe.preset.clear();
  recipe.fit = tableFitPreset(recipe.kind, instead);
  if (descent) recipe.fit.sw.leakWeight = 0.0;
  recipe.fit.setSeed(seed);
  recorded->notes.push_back(
      fmt::format("direct fits are by {} with its usual effort: a fit of the table's own effort, by {}, "
                  "takes some {:.2g} "
                  "CPU seconds. The ratio at nodes need not be 1",
                  fitterName(instead), fitterName(fitter), seconds));
}

// As the table stores and reads back a matrix.
std::optional<Matrix3d> asStored(const Matrix3d& m, const TableInfo& info) {
  const bool inverse = info.stores == MatrixStorage::kMinv;
  const Matrix3d stored =
      normalized(inverse ? Matrix3d(m.inverse()) : m, info.normalization).cast<float>().cast<double>();
  const Matrix3d read = inverse ? Matrix3d(stored.inverse()) : stored;
  if (!read.allFinite() || read.determinant() == 0.0) return std::nullopt;
  return read;
}

}  // namespace

DirectFit::DirectFit(const Table& table, int threads)
    : table_(table), recorded_(fitFromProvenance(table.info())) {
  boundEffort(&recorded_);
  const LobeFitOptions& fit = recorded_.recipe.fit;
  if (table.isIsotropic() && recorded_.hasFitter && fit.fitter == Fitter::kL3)
    chain_ = fitIsotropicTable(table.info().axes, table.info().alphaFloor, fit.l3, threads);
}

std::optional<Matrix3d> DirectFit::operator()(const LobeParameters& parameters, const Lobe& lobe,
                                              const LobeMoments& moments, const Matrix3d& fetched) const {
  const LobeFitOptions& fit = recorded_.recipe.fit;
  if (chain_)
    return asStored(fitBetweenNodes(*chain_, parameters.theta, parameters.alphaX, fit.l3).m, table_.info());
  // how the authors of such a table began is not known
  if (table_.isIsotropic() && fit.fitter == Fitter::kL3)
    return asStored(fitIsotropicEntry(lobe, moments, fetched, fit.l3).m, table_.info());
  const NodeFit alone =
      fitNode(planNode(parameters, table_.isIsotropic(), recorded_.recipe.symmetry), table_.info().brdf, fit);
  if (!alone.usable) return std::nullopt;
  return asStored(alone.m, table_.info());
}

}  // namespace ltcfit
