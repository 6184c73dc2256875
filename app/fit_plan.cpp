// ltcfit fit --plan and fit --scene: the smallest tables that keep to an error over a scene.
#include "app/fit_plan.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/fit_summary.h"
#include "app/progress.h"
#include "app/shell_quoted.h"
#include "app/table_arguments.h"
#include "base/diagnostics.h"
#include "base/refusal.h"
#include "export/atomic_file.h"
#include "export/json_table.h"
#include "export/read_table.h"
#include "tailor/plan_json.h"
#include "tailor/plan_text.h"
#include "tailor/table_designs.h"
#include "tailor/tailored_table.h"
#include "tailor/verification.h"

namespace ltcfit::app {
namespace {

using OrderedJson = nlohmann::ordered_json;

const char* kindName(const LobeDistribution& d) {
  return d.isotropic ? "isotropic" : "anisotropic";
}

const char* precisionName(Precision p) {
  return p == Precision::kHalf ? "half" : "float";
}

// NAME.json, or NAME-iso.json and NAME-aniso.json where there are two.
std::vector<std::string> outputsOf(const std::string& output, const ScenePlan& plan) {
  if (plan.tables.size() == 1) return {output};
  const std::filesystem::path path(output);
  std::vector<std::string> out;
  for (const PlannedTable& t : plan.tables) {
    std::filesystem::path name = path.parent_path() / path.stem();
    name += t.distribution.isotropic ? "-iso" : "-aniso";
    name += path.extension();
    out.push_back(name.string());
  }
  return out;
}

Provenance provenanceOf(const PlanFitArguments& a, const ScenePlan& plan, const TailoredTable& made,
                        bool isotropic) {
  const PlanRequest& r = plan.request;
  Provenance p;
  p.tool = "ltcfit";
  p.toolVersion = LTCFIT_VERSION;
  p.seed = r.seed;
  p.command = a.plan.empty() ? "ltcfit fit --scene " + shellFileName(a.scene.scene)
                             : "ltcfit fit --plan " + shellFileName(a.plan);
  if (a.plan.empty()) {  // a plan says the rest itself
    if (r.maxError > 0.0) p.command += fmt::format(" --max-error {}", r.maxError);
    if (r.maxBytes > 0) p.command += fmt::format(" --max-bytes {}", r.maxBytes);
    p.command += fmt::format(" --margin {} --alpha-floor {}", r.margin, r.alphaFloor);
    if (!a.scene.views.empty())
      p.command += fmt::format(" --views {} {}", a.scene.views[0], a.scene.views[1]);
    p.command += fmt::format(" --seed {}", r.seed);
  }
  const TableKind kind = isotropic ? TableKind::kIsotropic : TableKind::kAnisotropic;
  p.options = {{"scene", plan.scene},
               {"fitter", std::string(fitterName(kDefaultFitter))},
               {"preset", std::string(defaultPreset(kind, kDefaultFitter))},
               {"max_error", r.maxError},
               {"max_bytes", static_cast<std::int64_t>(r.maxBytes)},
               {"margin", r.margin},
               {"alpha_floor", r.alphaFloor},
               {"shipped_precision", std::string(precisionName(made.precision))},
               {"shipped_bytes", static_cast<std::int64_t>(made.step.bytes)},
               {"measured_error", made.step.error.mean}};
  return p;
}

// The table for every scene, as it would be shipped: read, or fitted.
Table fullTable(const PlanFitArguments& a, const std::vector<Table>& given,
                const LobeDistribution& distribution, const InterpolationModelOptions& options) {
  std::optional<Table> table;
  for (const Table& t : given)
    if (t.isIsotropic() == distribution.isotropic) table = t;
  if (!table) {
    Progress progress("full table", a.scene.quiet);
    table = fitAxes(fullAxes(distribution.isotropic, options.alphaFloor), distribution.isotropic,
                    {"norm", "fresnel"}, options,
                    [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  }
  if (!table) throw std::runtime_error("the full table has entries that cannot be used");
  return shippedTable(*table, Precision::kHalf);
}

OrderedJson errorToJson(const FetchError& e) {
  return {{"mean", e.mean},         {"standard_error", e.standardError},
          {"p99", e.p99},           {"max", e.max},
          {"singular", e.singular}, {"look_ups", e.lookUps}};
}

OrderedJson verificationToJson(const Verification& v, double bound) {
  return {{"tailored", errorToJson(v.tailored)},
          {"full", errorToJson(v.full)},
          {"holds", v.holds(bound)},
          {"light_errors",
           {{"direct_fits", v.directLight}, {"tailored", v.tailoredLight}, {"full", v.fullLight}}},
          {"scenes",
           {{"count", v.scenes},
            {"tailored_rmse", v.tailoredRmse},
            {"full_rmse", v.fullRmse},
            {"reference_rmse", v.referenceRmse},
            {"worse_by_more_than_the_bound", v.worseScenes}}}};
}

void printVerification(const Verification& v, double bound) {
  fmt::print("  verified at {} look-ups that nothing was fitted to:\n", v.tailored.lookUps);
  const auto line = [](const char* name, const FetchError& e) {
    fmt::print("    {:<9} mean {:.6f}  p99 {:.5f}  max {:.5f}{}\n", name, e.mean, e.p99, e.max,
               e.singular > 0 ? fmt::format("  {} without an inverse", e.singular) : "");
  };
  line("tailored", v.tailored);
  line("full", v.full);
  if (bound > 0.0)
    fmt::print("    the bound of {:g} {}\n", bound, v.holds(bound) ? "holds" : "DOES NOT HOLD");
  fmt::print("  error against the true lobes (light_s, light_m, light_l):\n");
  const auto lights = [](const char* name, const LightErrors& e) {
    fmt::print("    {:<12} {:.5f}  {:.5f}  {:.5f}\n", name, e[0], e[1], e[2]);
  };
  lights("direct fits", v.directLight);
  lights("tailored", v.tailoredLight);
  lights("full", v.fullLight);
  if (v.scenes > 0)
    fmt::print(
        "  pictures of {} random scenes by the double-precision renderer: RMSE {:.5f}, full table {:.5f}; "
        "worse by more than the bound in {}\n",
        v.scenes, v.tailoredRmse, v.fullRmse, v.worseScenes);
}

// What was made of one table of the plan.
struct Made {
  TailoredTable table;
  Times times;
  std::optional<Verification> verification;
};

OrderedJson toJson(const Made& made, const PlannedTable& planned, const std::string& output, double bound) {
  OrderedJson steps = OrderedJson::array();
  for (const TailorStep& s : made.table.steps)
    steps.push_back({{"nodes", s.design.nodes},
                     {"bytes", s.bytes},
                     {"predicted", s.design.error},
                     {"measured", s.error.mean}});
  OrderedJson json{{"output", output},
                   {"kind", kindName(planned.distribution)},
                   {"kept", made.table.kept},
                   {"max_error", planned.maxError},
                   {"nodes", made.table.step.design.nodes},
                   {"bytes", made.table.step.bytes},
                   {"precision", precisionName(made.table.precision)},
                   {"error", errorToJson(made.table.step.error)},
                   {"tables_tried", std::move(steps)},
                   {"cpu_seconds", made.times.cpu},
                   {"wall_seconds", made.times.wall}};
  if (made.verification) json["verification"] = verificationToJson(*made.verification, bound);
  return json;
}

void printText(const Made& made, const PlannedTable& planned, double bound) {
  const TailorStep& s = made.table.step;
  std::string axes;
  for (const Axis& axis : made.table.table->info().axes) axes += (axes.empty() ? "" : " x ") + axis.name;
  fmt::print("{} table: {} nodes ({}), {} in {}; {} tables tried, {:.1f} CPU s, {:.1f} s wall\n",
             kindName(planned.distribution), nodesText(s.design.nodes), axes, bytesText(s.bytes),
             made.table.precision == Precision::kHalf ? "halves" : "floats", made.table.steps.size(),
             made.times.cpu, made.times.wall);
  fmt::print("  look-ups against direct fits, {} of the scene: mean {:.6f}  p99 {:.5f}  max {:.5f}\n",
             s.error.lookUps, s.error.mean, s.error.p99, s.error.max);
  if (made.verification) printVerification(*made.verification, bound);
}

Made make(const PlanFitArguments& a, const std::vector<Table>& given, const ScenePlan& plan,
          const PlannedTable& planned, std::size_t maxBytes) {
  const LobeDistribution& distribution = planned.distribution;
  const Stopwatch watch;
  Made made;
  const InterpolationModelOptions options =
      modelOptions(plan.request, distribution.isotropic, a.scene.threads);
  const std::vector<AxisRange> ranges =
      axisRanges(distribution, plan.request.alphaFloor, plan.request.margin);
  TailorOptions tailor;
  tailor.maxError = planned.maxError;
  tailor.maxBytes = maxBytes;
  tailor.model = options;
  {
    Progress progress(kindName(distribution), a.scene.quiet);
    const auto update = [&](std::size_t done, std::size_t total) { progress.update(done, total); };
    const InterpolationModel model(distribution, ranges, options, update);
    made.table = tailorTable(distribution, TableDesigns(model), tailor, update);
  }
  made.times = watch.elapsed();
  if (a.verify && made.table.kept) {
    VerificationOptions verify;
    verify.seed = static_cast<std::uint64_t>(plan.request.seed) + 1000;
    const Table full = fullTable(a, given, distribution, options);
    Progress progress("verify", a.scene.quiet);
    made.verification = verifyTable(
        shippedTable(*made.table.table, made.table.precision), full, distribution, tailor.maxError, options,
        verify, [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  }
  return made;
}

void explainRefusal(const Made& made, const PlannedTable& planned, std::size_t maxBytes) {
  const std::string within = maxBytes > 0 ? fmt::format(" within {}", bytesText(maxBytes)) : std::string();
  const double bound = planned.maxError;
  const char* const kind = kindName(planned.distribution);
  if (made.table.kept) {
    complain(fmt::format(
        "{} table: at look-ups that nothing was fitted to the mean error is {:.6f}, above {:g}: no "
        "table was written",
        kind, made.verification->tailored.mean, bound));
  } else if (!made.table.table) {
    complain(fmt::format("{} table: there is none{}: no table was written", kind, within));
  } else {
    complain(
        fmt::format("{} table: a mean error of {:g} is out of reach{}; the best one tried has {:.2g} ({} "
                    "nodes, {}): no table was written",
                    kind, bound, within, made.table.step.error.mean, nodesText(made.table.step.design.nodes),
                    bytesText(made.table.step.bytes)));
  }
}

}  // namespace

int fitPlanCommand(const CLI::App& command, const PlanFitArguments& a) {
  if (!a.plan.empty() && !a.scene.scene.empty())
    throw InputError("fit: --plan and --scene exclude each other");
  if (a.plan.empty() && a.scene.scene.empty())
    throw InputError("fit: need --plan or --scene, or a subcommand; --help lists all");
  if (a.output.empty()) throw InputError("--output is required");
  if (!a.full.empty() && !a.verify) throw InputError("--full needs --verify");
  if (!a.plan.empty()) {
    for (const char* option :
         {"--max-error", "--max-bytes", "--margin", "--alpha-floor", "--lights", "--views", "--seed"})
      if (command.count(option) > 0)
        throw InputError(std::string(option) + " needs --scene: the plan says it (field request)");
  }
  checkWritable(a.output);
  const ScenePlan plan =
      a.plan.empty() ? planOf(command, a.scene) : planFromJson(readFile(a.plan, kMaxPlanBytes), a.plan);
  if (plan.tables.empty())
    throw InputError(
        a.plan.empty()
            ? fmt::format("{}: {} {} was not written; ltcfit scene lists its materials", a.scene.scene,
                          plan.notes.back(), a.output)
            : fmt::format(
                  "{}: the plan has no tables, since its scene needs none: {} was not written; notes in the "
                  "plan say why",
                  a.plan, a.output));
  std::vector<Table> given;
  for (const std::string& path : a.full) given.push_back(readInput(path).table);
  const std::vector<std::string> outputs = outputsOf(a.output, plan);
  for (const std::string& output : outputs) {
    for (const std::string& input : {a.plan, a.scene.scene})
      if (!input.empty() && isSameFile(output, input)) throw InputError(output + ": is what is read");
    checkWritable(output);
  }
  OrderedJson json{{"scene", plan.scene}, {"tables", OrderedJson::array()}};
  std::size_t left = plan.request.maxBytes;
  int exitCode = kExitOk;
  std::vector<std::pair<std::string, std::string>> files;
  std::vector<Made> kept;
  for (std::size_t i = 0; i < plan.tables.size() && exitCode == kExitOk; ++i) {
    const PlannedTable& planned = plan.tables[i];
    const double bound = planned.maxError;
    // where bytes alone count, the plan has shared them out
    const std::size_t maxBytes = bound == 0.0 ? planned.maxBytes : left;
    Made made = make(a, given, plan, planned, maxBytes);
    const bool verified = !made.verification || bound == 0.0 || made.verification->holds(bound);
    if (a.scene.json) json["tables"].push_back(toJson(made, planned, outputs[i], bound));
    if (!made.table.kept || !verified) {
      explainRefusal(made, planned, maxBytes);
      exitCode = kExitQuality;
      break;
    }
    if (left > 0) left = left > made.table.step.bytes ? left - made.table.step.bytes : 1;
    TableInfo info = made.table.table->info();
    info.provenance = provenanceOf(a, plan, made.table, planned.distribution.isotropic);
    files.emplace_back(outputs[i], tableToJson(Table(info, made.table.table->data())));
    kept.push_back(std::move(made));
  }
  if (exitCode == kExitOk)
    for (const auto& [path, text] : files) writeFileAtomically(path, text);
  if (a.scene.json) {
    fmt::print("{}\n", json.dump(2, ' ', false, OrderedJson::error_handler_t::replace));
  } else if (!a.scene.quiet) {
    for (std::size_t i = 0; i < kept.size(); ++i) printText(kept[i], plan.tables[i], plan.tables[i].maxError);
    if (exitCode == kExitOk)
      for (const std::string& output : outputs) fmt::print("wrote {}\n", output);
  }
  return exitCode;
}

void addPlanFitOptions(CLI::App& command, PlanFitArguments& a) {
  command
      .add_option("--plan", a.plan,
                  "Fit the tables of a plan (ltcfit scene -o). Read are its bounds and its distributions of "
                  "lobes;\nsizes are found anew, by measuring")
      ->type_name("plan.json");
  command
      .add_option("--scene", a.scene.scene,
                  "The same straight from a scene, as ltcfit scene reads it, by the options below")
      ->type_name("SCENE");
  command
      .add_option("-o,--output", a.output,
                  "Table file to write; where two are needed, FILE-iso.json and FILE-aniso.json")
      ->type_name("FILE.json");
  addPlanOptions(command, a.scene);
  command.add_flag("--verify", a.verify,
                   "Judge table and full table at unseen look-ups, against the true lobes and in pictures");
  command
      .add_option("--full", a.full,
                  "Table to verify against, one for each kind; else the full one is fitted (10 to 20 s)")
      ->type_name("T.json");
  command.add_flag("--json", a.scene.json, "Print the summary as JSON");
  command.add_flag("-q,--quiet", a.scene.quiet, "Print nothing but errors");
}

}  // namespace ltcfit::app
