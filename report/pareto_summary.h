// What the fits of `ltcfit pareto` come to: times and errors of each setting, and which no other beats.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

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
  /// ratio.median over the first entry, the first two, ... all: what two settings are compared by where one
  /// ran on fewer.
  std::vector<double> first;
  bool front = false;  ///< beaten by no other setting
};

struct SettingSummary {
  std::size_t entries = 0;
  std::size_t runs = 0;
  Spread cpuSeconds;  ///< over repeats, of the mean over entries
  std::array<SettingErrors, kParetoMetrics> errors;
  std::size_t notConverged = 0;  ///< runs
  std::size_t nonFinite = 0;     ///< runs
};

/// How the error of `a` compares with that of `b`: their ratio over the entries that both have.
double errorOver(const SettingSummary& a, const SettingSummary& b, std::size_t metric);

/// Whether `a` takes no longer than `b` and is no worse over the entries that both have, and one of the two
/// is strictly better. Equal ones do not beat each other; what failed beats nothing.
bool beats(const SettingSummary& a, const SettingSummary& b, std::size_t metric);

/// `runs` of each setting, at least one run in each, all from the first entry on; no two numbers of entries
/// in one setting.
std::vector<SettingSummary> summarizePareto(const std::vector<SettingRuns>& runs);

}  // namespace ltcfit
