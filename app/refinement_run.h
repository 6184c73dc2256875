// A joint refinement from table to file: what ltcfit refine and fit --refine share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/fit_summary.h"
#include "fit/table_refinement.h"

namespace ltcfit::app {

struct RefinementRequest {
  RefinementOptions options;  ///< valid
  /// What the refined table stores, and so what is interpolated; M for anisotropic tables.
  MatrixStorage stores = MatrixStorage::kM;
  bool keepScale = false;  ///< of anisotropic matrices: unit third columns
  bool resume = false;
  bool quiet = false;
};

/// Where a table to refine comes from, for the provenance of the refined one.
struct RefinementSource {
  std::string name;  ///< of its file, without folders
  /// Whether the table is, bit for bit, what its provenance's command gives: then the refined one is what
  /// that command gives with --refine.
  bool asFitted = false;
};

/// M for anisotropic tables, Minv for isotropic ones: as the textures of engines hold them.
MatrixStorage usualStorage(bool isotropic);

/// The defaults of a kind of table with the numbers given, valid; throws InputError naming the
/// option as
/// "--`prefix`NAME", its value and its range.
RefinementOptions refinementOptions(bool isotropic, int points, int iterations, std::int64_t seed,
                                    int threads, const std::string& prefix);

struct RefinementRun {
  Table before;  ///< the table as given, in the form in which it is refined
  RefinementResult result;
  std::optional<int> resumedAt{};  ///< iteration
  Times times{};
};

/// Refuses a refinement that there is no memory for, naming the option; throws InputError.
void requireRefinementMemory(int points, std::size_t nodes, const std::string& option);

/// Refines the table, keeping a checkpoint in `checkpoint` meanwhile (none where that is empty), and, if all
/// nodes are usable, writes it to `output`. Throws InputError for a table that cannot be refined so, and for
/// a checkpoint that does not belong to this run.
RefinementRun refineToFile(const Table& table, const RefinementSource& source,
                           const RefinementRequest& request, const std::string& output,
                           const std::string& checkpoint);

/// Exit code 3 with a message where nodes are unusable, else 0.
int refuseUnusableRefinement(const RefinementRun& run);

}  // namespace ltcfit::app
