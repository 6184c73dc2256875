// Error against CPU time: every fitter over its ladder of efforts, at the same entries.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "report/metrics.h"
#include "report/pareto_ladder.h"

namespace ltcfit {

struct ParetoMetric {
  std::string_view name;
  std::string_view unit;     ///< empty: none
  std::string_view meaning;  ///< one sentence
};
inline constexpr std::size_t kParetoMetrics = 9;
/// Those of EntryMetrics that a fit can be judged by, in the order in which they are printed, and "light".
const std::array<ParetoMetric, kParetoMetrics>& paretoMetrics();
/// Of "light", the geometric mean of light_s, light_m and light_l: what defaults are judged by first.
inline constexpr std::size_t kParetoLight = 6;

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

/// One fit. Infinite errors where it ended with a matrix that is not finite or has no inverse.
struct ParetoRun {
  double cpuSeconds = 0.0;  ///< of the thread: moments of the lobe, its samples and start, and the fit
  std::array<double, kParetoMetrics> errors{};
  bool converged = false;
};

/// The fits of one setting: [repeat][entry], the first entries of the run.
using SettingRuns = std::vector<std::vector<ParetoRun>>;

/// Median over repeats, smallest and largest.
struct Spread {
  double median = 0.0;
  double low = 0.0;
  double high = 0.0;
};
/// Of one value or more; the mean of the middle two of an even number.
Spread spreadOf(std::vector<double> values);

struct SettingErrors {
  /// Over repeats, of the geometric mean over entries of the error over the best one that any fit of any
  /// setting has at the entry: >= 1; infinite where a fit failed.
  Spread ratio;
  /// ratio.median times the geometric mean over all entries of the best errors: the setting's geometric mean
  /// error, estimated where it ran on fewer.
  double value = 0.0;
  bool front = false;  ///< no other setting beats it (report/front.h) in cpuSeconds.median and ratio.median
};

struct SettingSummary {
  std::size_t entries = 0;
  std::size_t runs = 0;
  Spread cpuSeconds;  ///< over repeats, of the mean over entries
  std::array<SettingErrors, kParetoMetrics> errors;
  std::size_t notConverged = 0;  ///< runs
  std::size_t nonFinite = 0;     ///< runs
};

/// `runs` of each setting, at least one run in each, all from the first entry on; no two numbers of entries
/// in one setting.
std::vector<SettingSummary> summarizePareto(const std::vector<SettingRuns>& runs);

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
