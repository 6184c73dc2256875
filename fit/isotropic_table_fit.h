// Fits a whole isotropic table: the order of the entries, their warm starts, checks and second tries.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fit/entry_fit.h"
#include "fit/table_plan.h"
#include "ltc/table.h"

namespace ltcfit {

struct IsotropicFitOptions {
  IsotropicTableOptions table;
  EntryFitOptions entry;
  int threads = 0;  ///< 0: as many as OpenMP offers

  /// False with a message naming the option, its value and its range.
  bool isValid(std::string* error) const;
};

/// Where an entry's fit began.
enum class WarmStart { kIdentity, kAlphaNeighbour, kThetaNeighbour, kShape };
/// "identity", "alpha-neighbour", "theta-neighbour" or "shape" (the lobe's own median direction and widths).
std::string_view warmStartName(WarmStart start);

struct EntryReport {
  EntryFit fit;
  WarmStart warmStart = WarmStart::kIdentity;
  int totalEvaluations = 0;  ///< all tries together
  bool refitted = false;     ///< was tried again from other starts
  bool improved = false;     ///< and got better by it
  bool usable = false;       ///< invertible in float32, and better than no light at all
};

struct IsotropicFitResult {
  TableInfo info;                    ///< without provenance
  std::vector<float> data;           ///< float32, ready for Table
  std::vector<EntryReport> reports;  ///< in the order of the nodes, theta slowest
  std::size_t refitted = 0;
  std::size_t improvedByRefit = 0;
  std::size_t notConverged = 0;
  std::size_t unusable = 0;
  long long evaluations = 0;
  double largestMomentError = 0.0;  ///< estimated absolute error of norm and Fresnel, worst node
};

/// Called after each finished entry, from any thread but never from two at once.
using FitProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Fits every entry, as Heitz et al. 2016 describe: from alpha = 1 down at normal view, then along theta from
/// the neighbour before, rows of equal alpha in parallel. An entry that did not converge, or whose relativeL3
/// is more than kNeighbourFactor times the median of its neighbours', is fitted again from each neighbour and
/// from the lobe's own shape, with a wider simplex. The result is the same, bit for bit, for any number of
/// threads. `options` must be valid.
IsotropicFitResult fitIsotropicTable(const IsotropicFitOptions& options, const FitProgress& progress = {});

/// The same for axes of any ranges, sizes and warps, theta and alpha, whose values are valid for a Table.
IsotropicFitResult fitIsotropicTable(std::vector<Axis> axes, double alphaFloor, const EntryFitOptions& entry,
                                     int threads, const FitProgress& progress = {});

/// Fits the lobe at (theta, alpha) as a node of this table would be fitted: at a node it is the node's own
/// fit; elsewhere it begins at the next node towards alpha = 1 and normal view, and is tried again from all
/// nodes about it and from the lobe's own shape where a node would be. `entry` must be what the table was
/// fitted with.
EntryFit fitBetweenNodes(const IsotropicFitResult& table, double theta, double alpha,
                         const EntryFitOptions& entry);

/// How much worse than its neighbours (their upper median) an entry may be before it is tried again. In the
/// default table, and with family 3, all entries above kGoodEnough end below 1.04; the local minima seen
/// began at 1.2 and more (ltcfit fit iso --report).
inline constexpr double kNeighbourFactor = 1.15;
/// A relative L3 error below which no entry is tried again: the neighbours' then differ by sampling noise.
inline constexpr double kGoodEnough = 2e-3;

}  // namespace ltcfit
