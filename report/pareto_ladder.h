// What `ltcfit pareto` fits with: every fitter at several efforts.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "fit/lobe_fit.h"

namespace ltcfit {

/// One rung: a fitter with the effort it may take.
struct FitSetting {
  std::string fitter;  ///< fitterName, or "moments": the start of all others, not fitted
  std::string name;    ///< its effort, "1024 lights"
  std::vector<std::pair<std::string, double>> effort;  ///< the numbers in it
  std::string preset;                                  ///< that this is; may be empty
  bool isDefault = false;  ///< tableFitPreset of the default fitter, unchanged: what `ltcfit fit` does
  LobeFitOptions options;  ///< seed 1; of "moments" those of the default, whose start it is

  bool fits() const { return fitter != "moments"; }
};

/// The settings of a kind of table, fitter by fitter, in each the cheap ones first: the start alone; light
/// with 64 to 8192 lights; sw with 512 x 24 samples x directions to the preset "fine", in one level and in
/// two; l3 with 256 to 4096 samples and 100 to 1000 evaluations; sw-sgd up to the paper's 10,000 x 2048 x 64.
/// All presets are among them.
std::vector<FitSetting> paretoLadder(TableKind kind);

/// CPU seconds that a fit takes, to a factor of two or so: from the options alone, so that what follows from
/// it is the same on every machine.
double nominalSeconds(const FitSetting& setting);

/// How much of a run a setting takes part in: its first `entries`, `repeats` times.
struct FitShare {
  std::size_t entries;
  std::size_t repeats;
};

/// All, unless that takes nominally longer than two fits with the paper's setting (sw-sgd, "paper"): then so
/// many entries as do not, at least two, and of the repeats those that leave it at that.
FitShare shareOf(const FitSetting& setting, std::size_t entries, std::size_t repeats);

}  // namespace ltcfit
