// The options that the fits of tables and of single lobes share.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fit/isotropic_table_fit.h"
#include "fit/table_fit.h"
#include "fit/table_refinement.h"

namespace ltcfit::app {

enum class FitKind { kIsotropic, kAnisotropic, kEntry };

struct FitArguments {
  FitKind kind = FitKind::kIsotropic;
  std::string output;
  std::string reportPath;
  std::string size;
  std::string axes;  // of tables: axes_argument.h
  std::string fitter = "light";
  std::string preset;  // empty: the fitter's default
  std::string family = "4";
  std::string symmetry = "during";
  int samples = 0;     // 0: the preset's
  int directions = 0;  // 0: the preset's
  double alphaFloor = IsotropicTableOptions{}.alphaFloor;
  double thetaMax = IsotropicTableOptions{}.thetaMax;
  std::optional<double> leakWeight;  // the fitter's default
  std::string weighting = "absolute";
  std::optional<double> sizeExponent;  // the default of the table
  int lights = 0;                      // 0: the preset's
  int maxEvaluations = NelderMeadOptions{}.maxEvaluations;
  int threads = 0;
  std::int64_t seed = 1;
  int scorePoints = 0;
  bool refine = false;
  int refinePoints = RefinementOptions{}.points;
  int refineIterations = RefinementOptions{}.iterations;
  bool resume = false;
  bool quiet = false;
  bool json = false;
};

/// Adds the options that say how a lobe is fitted.
void addFitterOptions(CLI::App& command, FitArguments& a);
/// Adds those that only tables have.
void addTableOptions(CLI::App& command, FitArguments& a);

/// Throws InputError for options that do not go together or are out of range.
void checkFitArguments(const CLI::App& command, const FitArguments& a);
/// "64x32" to {64, 32}, `count` numbers; InputError otherwise.
std::vector<std::size_t> parseSize(const std::string& text, std::size_t count);
/// The preset asked for, or the fitter's default.
std::string presetOf(const FitArguments& a);
/// The leak weight asked for, or the default of fitter and table.
double leakWeightOf(const FitArguments& a);
double sizeExponentOf(const FitArguments& a);
/// How a lobe is fitted, valid.
TableFitOptions toFitOptions(const FitArguments& a);
/// Refuses what there is no memory for: the fit of a table of so many nodes, and its refinement. Throws
/// InputError.
void requireFitMemory(const FitArguments& a, std::size_t nodes);
SymmetryMode symmetryOf(const FitArguments& a);
/// Whether fitIsotropicTable does it (warm starts along the table), not fitTable.
bool isWarmStartedL3(const FitArguments& a);

/// The command that gives the same bytes: every option that matters, none that does not (threads, paths), and
/// none of --refine: the fit is the same.
Provenance makeProvenance(const FitArguments& a);

}  // namespace ltcfit::app
