#include "fit/memory_estimate.h"

namespace ltcfit {

// All numbers are differences of the peak resident set over sizes, on x86-64 with GCC 12 and Ceres 2.1.
double lobeFitBytes(const LobeFitOptions& options, TableKind kind) {
  switch (options.fitter) {
    case Fitter::kSlicedWassersteinSgd: {
      const double samples = options.sgd.samples;
      return samples * (124.0 + 8.0 * options.sgd.slices);
    }
    case Fitter::kL3:
      return 64.0 * options.l3.samples;
    case Fitter::kLight:
      return 281.0 * options.light.lights.lights;
    case Fitter::kSlicedWasserstein:
      break;
  }
  const SlicedWassersteinLevel& last = options.sw.levels.back();
  // cells of the projected lobe; half of the slices for the mirror symmetry of isotropic lobes
  const double cells = kind == TableKind::kIsotropic ? 970.0 : 2900.0;
  return 107.0 * last.samples + cells * last.slices;
}

double nodeFitBytes(TableKind kind) {
  return kind == TableKind::kIsotropic ? 500.0 : 650.0;
}

double refinementBytes(std::size_t points, std::size_t nodes) {
  // half of it lights and quads, a third the rows of the solver's Jacobian
  constexpr double kLookUpBytes = 57000.0;
  return kLookUpBytes * static_cast<double>(points + nodes);
}

}  // namespace ltcfit
