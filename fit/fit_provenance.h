// What the provenance of a table keeps of its fit: one writer, and the reader that is its inverse.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fit/lobe_fit.h"
#include "fit/table_plan.h"
#include "ltc/table.h"

namespace ltcfit {

/// How the lobes of a table are fitted.
struct FitRecipe {
  TableKind kind = TableKind::kAnisotropic;
  std::string preset;  ///< as in tableFitPreset; empty: the fitter's default
  LobeFitOptions fit;
  SymmetryMode symmetry = SymmetryMode::kDuring;
};

/// Everything that the fit of a lobe depends on, except for its seed (Provenance::seed), under the names of
/// the program's options with underscores: numbers of the preset are left out.
std::vector<std::pair<std::string, Provenance::Value>> provenanceOptions(const FitRecipe& recipe);

struct RecordedFit {
  FitRecipe recipe;        ///< valid
  bool hasFitter = false;  ///< the provenance names a fitter
  /// The options that no fit has, or that are out of range, and what is taken instead.
  std::vector<std::string> notes;
};

/// The recipe whose provenanceOptions the table has, with its seed. Files are not trusted: an option that is
/// missing or makes no sense is that of the preset. A table that names no fitter is taken for one of the
/// papers: isotropic ones by "l3", anisotropic ones by "sw" with its preset "standard".
///
/// Of a refined table this is the fit that it was refined from.
RecordedFit fitFromProvenance(const TableInfo& info);

}  // namespace ltcfit
