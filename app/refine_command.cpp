// ltcfit refine: all entries of a table together, for what is read between its nodes.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/refinement_run.h"
#include "app/refinement_summary.h"
#include "app/table_arguments.h"
#include "export/atomic_file.h"
#include "export/read_table.h"

namespace ltcfit::app {
namespace {

struct RefineArguments {
  std::string table;
  ReadOptions input;
  std::string output;
  std::string storedAs;  // empty: usualStorage
  int points = RefinementOptions{}.points;
  int iterations = RefinementOptions{}.iterations;
  int fresh = kFreshLookUps;
  int threads = 0;
  std::optional<std::int64_t> seed;  // of the table
  bool keepScale = false;
  bool resume = false;
  bool quiet = false;
  bool json = false;
};

// The very bytes that its command gives: in other forms, and in tables of other versions, numbers differ.
bool isAsFitted(const TableFile& file) {
  const TableInfo& info = file.table.info();
  const Provenance& p = info.provenance;
  const bool command = p.command.starts_with("ltcfit fit iso ") || p.command.starts_with("ltcfit fit aniso ");
  return file.format == "JSON" && p.tool == "ltcfit" && p.toolVersion == LTCFIT_VERSION && command &&
         p.command.find(" --refine") == std::string::npos && info.stores == MatrixStorage::kM &&
         info.normalization == MatrixNormalization::kThirdColumnUnit;
}

// A table may be replaced by its refined self; its other files, and what is no table of ours, may not.
void checkOutput(const RefineArguments& a, const std::string& format) {
  checkWritable(a.output);
  for (const std::string& input : filesOfTable(a.table, a.input)) {
    if (isSameFile(a.output + ".part", input))
      throw InputError(input + ": --output would take this for the checkpoint of an interrupted run");
    if (isSameFile(a.output, input) && (input != a.table || format != "JSON"))
      throw InputError(fmt::format("{}: --output would overwrite this {}", input,
                                   input == a.table ? "table" : "part of the table"));
  }
  if (a.resume && isStream(a.output)) throw InputError("--resume: " + a.output + " is not a file");
}

int refineCommand(const RefineArguments& a) {
  checkWritable(a.output);
  const TableFile file = readInput(a.table, a.input);
  const TableInfo& info = file.table.info();
  const bool isotropic = file.table.isIsotropic();
  checkOutput(a, file.format);
  RefinementRequest request;
  request.stores = a.storedAs.empty() ? usualStorage(isotropic) : matrixStorageFromName(a.storedAs);
  request.keepScale = a.keepScale;
  request.resume = a.resume;
  request.quiet = a.quiet;
  if (!isotropic && request.stores == MatrixStorage::kMinv)
    throw InputError("--stored-as Minv is for isotropic tables: anisotropic ones are looked up by M");
  if (isotropic && a.keepScale)
    throw InputError("--keep-scale is for anisotropic tables: the scale of isotropic ones is never free");
  const bool ours = info.provenance.tool == "ltcfit" && info.provenance.seed >= 0;
  const std::int64_t seed =
      a.seed.value_or(ours ? info.provenance.seed : static_cast<std::int64_t>(RefinementOptions{}.seed));
  request.options = refinementOptions(isotropic, a.points, a.iterations, seed, a.threads, "");

  requireRefinementMemory(a.points, file.table.nodeCount(), "--points");

  const RefinementSource source{std::filesystem::path(a.table).filename().string(), isAsFitted(file)};
  const RefinementRun run = refineToFile(file.table, source, request, a.output,
                                         isStream(a.output) ? std::string() : a.output + ".part");
  const bool silent = a.quiet && !a.json;
  const RefinementFigures figures =
      measureRefinement(run, silent ? 0 : static_cast<std::size_t>(a.fresh), request.options);
  if (a.json) {
    nlohmann::ordered_json out{{"output", a.output},
                               {"nodes", file.table.nodeCount()},
                               {"stores", matrixStorageName(request.stores)},
                               {"points", a.points},
                               {"seed", seed}};
    addRefinement(run, figures, &out);
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else if (!a.quiet) {
    printRefinement(run, figures);
    if (run.result.unusable == 0) fmt::print("wrote {}\n", a.output);
  }
  return refuseUnusableRefinement(run);
}

}  // namespace

void addRefineCommand(CLI::App& app, CommandStatus& status) {
  CLI::App* const command = app.add_subcommand(
      "refine", "Move all entries of a table together, so that what is read between its nodes is best");
  command->footer(
      "What is fitted is what a texture's linear filter, or the look-up of an anisotropic table, yields.\n"
      "Norm and Fresnel stay. Halves need nothing else: export --precision half rounds the result.");
  auto a = std::make_shared<RefineArguments>();
  command
      ->add_option("table", a->table,
                   "Table to refine: whatever ltcfit writes, or a table that an engine ships")
      ->required()
      ->type_name("FILE");
  addTableInput(*command, a->input);
  command->add_option("-o,--output", a->output, "Table file to write (JSON); may be the one that is read")
      ->required()
      ->type_name("FILE.json");
  command
      ->add_option("--points", a->points,
                   "Look-ups over the table's domain that it is fitted for, 16..4194304; some for each node")
      ->capture_default_str();
  command->add_option("--iterations", a->iterations, "At most so many steps of all entries, 1..1000")
      ->capture_default_str();
  command
      ->add_option(
          "--stored-as", a->storedAs,
          "What the table written holds and is interpolated: Minv = the inverse over its middle\n"
          "element, as in the textures of engines, of isotropic tables only; M = the matrix, with a\n"
          "third column of length 1 in isotropic tables [isotropic: Minv; anisotropic: M]")
      ->check(CLI::IsMember({"M", "Minv"}));
  command->add_flag("--keep-scale", a->keepScale,
                    "Anisotropic: matrices with a third column of length 1, as fits and the 2022 table have\n"
                    "them. Without it the scale of each matrix is chosen too: its lobe is the same, those\n"
                    "between it and its neighbours are better");
  command
      ->add_option("--seed", a->seed,
                   "Seed of look-ups, lights and samples, 0..2^53 [that of the table's fit, else 1]")
      ->check(CLI::Range(std::int64_t{0}, kLargestSeed));
  command
      ->add_option("--fresh", a->fresh,
                   "Look-ups of the error figures in the summary, none of them fitted; 0 = no figures")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command->add_option("--threads", a->threads, "Threads; 0 = all cores. Does not change the result")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_flag(
      "--resume", a->resume,
      "Go on from FILE.json.part, which an interrupted run left: from its last whole iteration.\n"
      "As good as an unbroken run, but not the same bytes");
  command->add_flag("-q,--quiet", a->quiet, "Print nothing but errors");
  command->add_flag("--json", a->json, "Print the summary as JSON");
  command->callback([a, &status] { status.exitCode = refineCommand(*a); });
}

}  // namespace ltcfit::app
