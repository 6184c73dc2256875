// The runs behind ltcfit fit: each returns the exit code.
#pragma once

#include "app/fit_arguments.h"

namespace ltcfit::app {

/// Fits every lobe on its own and makes the table: sw, sw-sgd and, for anisotropic tables, l3. Keeps finished
/// lobes in FILE.json.part while it runs.
int fitTableCommand(const FitArguments& a, const TablePlan& plan);

/// The warm-started Nelder-Mead fit of an isotropic table.
int fitIsotropicL3(const FitArguments& a, const IsotropicTableOptions& tableOptions);

/// One lobe, printed. Angles in degrees.
struct EntryArguments {
  FitArguments fit;
  double alphaX = 0.5;
  double alphaY = 0.0;  // 0: alphaX
  double theta = 45.0;
  double phi = 0.0;
};
int fitEntryCommand(const EntryArguments& a);

/// Exit code 3 with a message where entries are unusable, else 0.
int refuseUnusable(std::size_t unusable, const FitArguments& a);

}  // namespace ltcfit::app
