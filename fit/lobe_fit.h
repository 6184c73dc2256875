// Fits one lobe: every fitter behind one call, and the options that tables are fitted with.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "fit/entry_fit.h"
#include "fit/light_fit.h"
#include "fit/sgd.h"
#include "fit/sliced_wasserstein_fit.h"
#include "fit/table_plan.h"
#include "ggx/moments.h"

namespace ltcfit {

enum class Fitter {
  kSlicedWasserstein,     ///< "sw": fitSlicedWasserstein
  kSlicedWassersteinSgd,  ///< "sw-sgd": descendSlicedWasserstein
  kL3,                    ///< "l3": Nelder-Mead on the L3 error
  kLight,                 ///< "light": fitLights
};
std::string_view fitterName(Fitter fitter);
/// Refusal for another name.
Fitter fitterFromName(std::string_view name);

struct LobeFitOptions {
  Fitter fitter = Fitter::kSlicedWasserstein;
  SlicedWassersteinFitOptions sw;  ///< also judges the results of the other fitters
  SgdOptions sgd;
  LightFitOptions light;
  EntryFitOptions l3;

  bool isValid(std::string* error) const;
  /// The seed of every fitter.
  void setSeed(std::uint64_t seed);
};

/// Tables whose lobes have other defaults.
enum class TableKind { kIsotropic, kAnisotropic };

/// The fitter of `ltcfit fit iso` and `ltcfit fit aniso`.
inline constexpr Fitter kDefaultFitter = Fitter::kLight;

/// The preset that a kind of table is fitted with by default: "fast", "standard"; of sw-sgd "quick", of l3
/// "".
std::string_view defaultPreset(TableKind kind, Fitter fitter);

/// The options that a kind of table is fitted with, seed 1; `preset` as in lightFitPreset,
/// slicedWassersteinPreset, or "quick" and "paper" for sw-sgd; empty for the default one. Throws
/// Refusal for a name that the fitter does not have.
LobeFitOptions tableFitPreset(TableKind kind, Fitter fitter, std::string_view preset = {});

/// What the fits know of a lobe. Not thread-safe: the judge has scratch memory.
class LobeFitTarget {
 public:
  /// Throws Refusal for an unknown brdf (fit/target_lobe.h).
  LobeFitTarget(const LobeJob& job, std::string_view brdf, const LobeFitOptions& options);

  const Lobe& lobe() const { return *lobe_; }
  const LobeMoments& moments() const { return moments_; }
  MatrixFamily family() const { return family_; }
  /// momentStart() of the lobe, in the family.
  const Eigen::Matrix3d& momentStart() const { return samples_.start; }
  const SlicedWassersteinTarget& samples() const { return samples_; }
  /// The SW1 of a matrix by the samples of the last level of options.sw. Made when first asked for: not every
  /// fitter needs it.
  ProjectedCdfLoss& judge();

 private:
  std::unique_ptr<Lobe> lobe_;
  LobeMoments moments_;
  MatrixFamily family_;
  SlicedWassersteinTarget samples_;
  SlicedWassersteinLevel judgeLevel_;
  std::uint64_t seed_;
  std::optional<ProjectedCdfLoss> judge_;
};

struct LobeFit {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();  ///< any scale, det of either sign, perhaps not finite
  int evaluations = 0;
  /// kConverged also for a stochastic descent that stayed finite: it has no other criterion.
  Termination termination = Termination::kFailure;
  double integralError = 0.0;  ///< kLight: estimated largest error of the true light integrals
  bool restarted = false;      ///< kLight, kSlicedWasserstein: the start's own descent did not arrive
  /// kLight: the best on unseen samples was the start, of which the others are overfitted improvements
  bool startKept = false;
  bool handedOver = false;  ///< kLight: the fit lost its lobe; it, sw's or the start, the best by SW1
};

/// Fits the lobe from `start`, a matrix of its family with det != 0. `options` must be valid, and those that
/// the target was made with.
LobeFit fitLobe(LobeFitTarget& target, const Eigen::Matrix3d& start, const LobeFitOptions& options);

}  // namespace ltcfit
