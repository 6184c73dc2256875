// From a fitted table to the file: as it is, or refined.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "app/fit_arguments.h"
#include "app/refinement_run.h"
#include "app/refinement_summary.h"

namespace ltcfit::app {

/// Refuses what --refine would stumble over after the fit: a checkpoint that it must not overwrite. Throws
/// InputError.
void checkRefinement(const FitArguments& a);

struct FitOutput {
  Table table;           ///< what the file holds
  bool written = false;  ///< not where a refined table has unusable nodes
  std::optional<RefinementRun> refinement{};
  RefinementFigures figures{};
};

/// Writes the table, usable at all nodes, or with --refine the refined one. Keeps FILE.json.refine.part
/// meanwhile.
FitOutput writeFit(const Table& table, const FitArguments& a);

/// What the refinement did, if there was one, and which file was written.
void printFitOutput(const FitOutput& output, const FitArguments& a);
/// Adds "refinement", if there was one.
void addFitOutput(const FitOutput& output, nlohmann::ordered_json* out);

/// The exit code: refuseUnusableRefinement.
int exitCodeOf(const FitOutput& output);

}  // namespace ltcfit::app
