// Error against CPU time: every fitter over its ladder of efforts, at the same entries.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "report/metrics.h"
#include "report/pareto_ladder.h"
#include "report/pareto_summary.h"

namespace ltcfit {

struct ParetoOptions {
  TableKind kind = TableKind::kAnisotropic;
  std::size_t entries = 24;
  std::size_t repeats = 3;
  std::uint64_t seed = 1;            ///< repeat r fits with seed + r
  std::vector<std::string> fitters;  ///< as FitSetting::fitter; empty: all
  /// The same samples and lights for all fits of an entry, so that they compare; of streams that no fit uses.
  MetricOptions metrics{.lights = 512};
  int threads = 0;  ///< 0: all cores
};

struct ParetoResult {
  std::vector<LobeParameters> entries;
  std::vector<FitSetting> settings;
  std::vector<SettingSummary> summaries;  ///< one for each setting
};

/// `done` of `total`, in nominal CPU seconds; one call at a time.
using ParetoProgress = std::function<void(double done, double total)>;

/// Fits and measures. Errors do not depend on the number of threads; times are measured.
ParetoResult runPareto(const ParetoOptions& options, const ParetoProgress& progress = {});

}  // namespace ltcfit
