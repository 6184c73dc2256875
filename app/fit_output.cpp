#include "app/fit_output.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "export/atomic_file.h"
#include "export/json_table.h"

namespace ltcfit::app {
namespace {

std::string checkpointOf(const FitArguments& a) {
  return isStream(a.output) ? std::string() : a.output + ".refine.part";
}

}  // namespace

void checkRefinement(const FitArguments& a) {
  std::error_code ignored;
  const std::string path = checkpointOf(a);
  if (!a.refine || a.resume || path.empty() || !std::filesystem::exists(path, ignored)) return;
  throw InputError(path +
                   ": of a refinement that was interrupted or is still going; --resume goes on with it, "
                   "without that file a run starts anew");
}

FitOutput writeFit(const Table& table, const FitArguments& a) {
  if (!a.refine) {
    writeFileAtomically(a.output, tableToJson(table));
    return {table, true};
  }
  RefinementRequest request;
  request.options = refinementOptions(a.kind == FitKind::kIsotropic, a.refinePoints, a.refineIterations,
                                      a.seed, a.threads, "refine-");
  request.stores = usualStorage(table.isIsotropic());
  request.resume = a.resume;
  request.quiet = a.quiet;
  const RefinementRun run = refineToFile(table, {"", true}, request, a.output, checkpointOf(a));
  const bool silent = a.quiet && !a.json;
  const RefinementFigures figures =
      measureRefinement(run, silent ? 0 : std::size_t{kFreshLookUps}, request.options);
  return {run.result.table, run.result.unusable == 0, run, figures};
}

void printFitOutput(const FitOutput& output, const FitArguments& a) {
  if (output.refinement) printRefinement(*output.refinement, output.figures);
  if (output.written) fmt::print("wrote {}\n", a.output);
}

void addFitOutput(const FitOutput& output, nlohmann::ordered_json* out) {
  if (output.refinement) addRefinement(*output.refinement, output.figures, out);
}

int exitCodeOf(const FitOutput& output) {
  return output.refinement ? refuseUnusableRefinement(*output.refinement) : kExitOk;
}

}  // namespace ltcfit::app
