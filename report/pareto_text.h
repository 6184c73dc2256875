// Why a default is what it is, in words, from the figures of a run.
#pragma once

#include <string>
#include <vector>

#include "report/pareto.h"

namespace ltcfit {

/// "light, 1024 lights (standard)".
std::string settingLabel(const FitSetting& setting);

struct ParetoDefault {
  std::string command;  ///< that uses the setting, "fit aniso"
  std::size_t setting;
  /// Whether it is on the front of `light`, and what beats it if not; its neighbours on that front; the other
  /// fitters at the time nearest to its own; the fronts that it is on and what beats it on the others.
  std::string why;
};

/// One where the run holds the default of its kind of table, none otherwise.
std::vector<ParetoDefault> explainDefaults(TableKind kind, const ParetoResult& result);

}  // namespace ltcfit
