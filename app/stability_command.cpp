// ltcfit stability: the fitters on stiff and extreme lobes, from good and bad starts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/commands.h"
#include "app/progress.h"
#include "app/shell_quoted.h"
#include "base/refusal.h"
#include "export/atomic_file.h"
#include "report/stability_json.h"
#include "report/stability_set.h"

namespace ltcfit::app {
namespace {

constexpr std::size_t kLargestSetFile = 1 << 20;
// Failed rows that are printed; the JSON has all.
constexpr std::size_t kPrintedRows = 20;

struct StabilityArguments {
  std::string set;
  std::string output;
  std::vector<std::string> fitters;
  int seeds = StabilityOptions{}.seeds;
  int threads = 0;
  bool full = false;
  bool quiet = false;
  bool json = false;
};

std::string lobeText(const LobeParameters& p) {
  const double degrees = 180.0 / std::numbers::pi;
  return fmt::format("alpha {:g} x {:g}, theta {:g}, phi {:g} degrees", p.alphaX, p.alphaY, p.theta * degrees,
                     p.phi * degrees);
}

void printSummary(const StabilityOptions& options, const StabilityResult& result) {
  fmt::print("{:<8}{:>6}{:>6}{:>8}{:>11}{:>13}{:>12}", "", "lobes", "runs", "failed", "restarted",
             "handed over", "start kept");
  for (std::size_t o = 0; o < kOutcomeCount; ++o)
    fmt::print("{:>{}}", outcomeName(static_cast<Outcome>(o)),
               outcomeName(static_cast<Outcome>(o)).size() + 2);
  fmt::print("\n");
  for (const Fitter fitter : options.fitters) {
    std::size_t rows = 0, runs = 0, failed = 0, restarted = 0, handedOver = 0, startKept = 0;
    std::array<int, kOutcomeCount> outcomes{};
    for (const StabilityRow& row : result.rows) {
      if (row.fitter != fitter) continue;
      ++rows;
      runs += row.runs.size();
      failed += row.broken.empty() ? 0 : 1;
      for (std::size_t o = 0; o < kOutcomeCount; ++o) outcomes[o] += row.outcomes[o];
      for (const StabilityRun& run : row.runs) {
        restarted += run.restarted ? 1 : 0;
        handedOver += run.handedOver ? 1 : 0;
        startKept += run.startKept ? 1 : 0;
      }
    }
    fmt::print("{:<8}{:>6}{:>6}{:>8}{:>11}{:>13}{:>12}", fitterName(fitter), rows, runs,
               fitter == kDefaultFitter ? fmt::format("{}", failed) : std::string("-"), restarted, handedOver,
               startKept);
    for (std::size_t o = 0; o < kOutcomeCount; ++o)
      fmt::print("{:>{}}", outcomes[o], outcomeName(static_cast<Outcome>(o)).size() + 2);
    fmt::print("\n");
  }
}

// The largest figures of the default fitter next to their limits.
void printLimits(const StabilityResult& result) {
  struct Worst {
    double value = -1.0;
    const StabilityRow* row = nullptr;
    void take(double v, const StabilityRow& r) {
      if (!(v <= value)) {
        value = v;
        row = &r;
      }
    }
  };
  fmt::print("\nlargest of {}, the default fitter:\n", fitterName(kDefaultFitter));
  for (const StabilityLimit& limit : stabilityLimits()) {
    Worst worst;
    for (const StabilityRow& row : result.rows)
      if (row.isDefault) worst.take(limitedFigure(row, limit.id), row);
    if (worst.row == nullptr) continue;
    fmt::print("  {:<15}{:>10.3g}  limit {:<7g}{}\n", limit.id, worst.value, limit.limit, limit.text);
    if (worst.value > 0.0) fmt::print("{:>29}at {}\n", "", lobeText(worst.row->parameters));
  }
  Worst seeds;
  for (const StabilityRow& row : result.rows)
    if (row.isDefault && row.tv <= kRepresentableTv) seeds.take(row.spreadSeeds, row);
  if (seeds.row != nullptr) {
    fmt::print(
        "  {:<15}{:>10.3g}  no limit     spread of SW1 over the seeds: the noise of samples and lights\n",
        "spread_seeds", seeds.value);
    fmt::print("{:>29}at {}\n", "", lobeText(seeds.row->parameters));
  }
}

void printRows(const StabilityResult& result) {
  std::size_t printed = 0;
  for (const StabilityRow& row : result.rows) {
    if (row.broken.empty() || printed++ >= kPrintedRows) continue;
    std::string broken;
    for (const std::string_view id : row.broken)
      broken += fmt::format("{}{} {:.3g}", broken.empty() ? "" : ", ", id, limitedFigure(row, id));
    fmt::print("  {}: {}\n", lobeText(row.parameters), broken);
  }
  if (printed > kPrintedRows) fmt::print("  and {} more\n", printed - kPrintedRows);
}

int stabilityCommand(const StabilityArguments& a) {
  if (!a.output.empty()) {
    checkWritable(a.output);
    if (!a.set.empty() && isSameFile(a.output, a.set))
      throw InputError(a.set + ": -o would overwrite the set of lobes");
  }
  StabilityOptions options;
  StabilitySet set;
  try {
    set = a.set.empty() ? defaultStabilitySet() : parseStabilitySet(readFile(a.set, kLargestSetFile));
  } catch (const Refusal& error) {
    throw InputError(fmt::format("{}: {}", a.set, error.what()));
  }
  options.lobes = lobesOf(set);
  options.seeds = a.seeds;
  options.full = a.full;
  options.threads = a.threads;
  if (!a.fitters.empty()) {
    options.fitters.clear();
    for (const std::string& name : a.fitters) {
      const Fitter fitter = fitterFromName(name);
      if (std::find(options.fitters.begin(), options.fitters.end(), fitter) == options.fitters.end())
        options.fitters.push_back(fitter);
    }
  }
  StabilityResult result;
  {
    Progress progress("stability", a.quiet);
    result =
        runStability(options, [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  }
  std::string command("ltcfit stability");
  if (!a.set.empty()) command += " --set " + shellFileName(a.set);
  for (const std::string& name : a.fitters) command += " --fitter " + shellQuoted(name);
  if (a.seeds != StabilityOptions{}.seeds) command += fmt::format(" --seeds {}", a.seeds);
  if (a.full) command += " --full";
  const std::string text = stabilityJson(result, options, set.name, command).dump(1) + "\n";
  if (!a.output.empty()) writeFileAtomically(a.output, text);
  if (a.json) {
    fmt::print("{}", text);
  } else {
    fmt::print("{} {}, \"{}\", each from {} starts\n\n", options.lobes.size(),
               options.lobes.size() == 1 ? "lobe" : "lobes", set.name, kStartCount);
    printSummary(options, result);
    fmt::print(
        "restarted: the start's own descent did not arrive; light and sw descend from the moments' start as "
        "well "
        "and keep\nthat. handed over: lights did not hold the lobe, another fit was taken; start kept: or "
        "the "
        "start itself.\n");
    const bool judged = std::any_of(result.rows.begin(), result.rows.end(),
                                    [](const StabilityRow& row) { return row.isDefault; });
    if (judged) printLimits(result);
    fmt::print("\n");
    for (const StabilityFinding& f : result.findings) {
      if (f.of > 0) fmt::print("{}:\n  {} of {} lobes: {}\n", f.title, f.rows, f.of, f.text);
    }
    if (judged) {
      fmt::print("\n{} of the rows of {} break a limit\n", result.failed, fitterName(kDefaultFitter));
      printRows(result);
    }
    if (!a.output.empty()) fmt::print("wrote {}\n", a.output);
  }
  return result.failed > 0 ? kExitQuality : kExitOk;
}

}  // namespace

void addStabilityCommand(CLI::App& app, CommandStatus& status) {
  CLI::App* const command =
      app.add_subcommand("stability",
                         "Try the fitters on stiff and extreme lobes, from good and from bad starts; exit "
                         "code 3 where a row\nof the default fitter breaks a limit");
  auto a = std::make_shared<StabilityArguments>();
  command
      ->add_option("--set", a->set,
                   "Lobes to try, as in data/stability_set.json, which is the default: all combinations of "
                   "its alpha,\nlambda, theta and phi")
      ->type_name("FILE.json");
  command
      ->add_option("--fitter", a->fitters,
                   "Only this fitter (light, sw, sw-sgd or l3); may be given more than once. The best known "
                   "SW1 is then\nthat of these")
      ->check(CLI::IsMember({"light", "sw", "sw-sgd", "l3"}))
      ->allow_extra_args(false);
  command->add_option("--seeds", a->seeds, "Seeds of the default fitter, the others have one; 1..100")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_flag("--full", a->full,
                    "All seeds for every fitter, and sw-sgd on every lobe, not on one of 24: an hour");
  command->add_option("-o,--output", a->output, "Also write all rows as JSON")->type_name("FILE.json");
  command->add_option("--threads", a->threads, "Threads; 0 = all cores. Does not change the result")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_flag("-q,--quiet", a->quiet, "No progress line");
  command->add_flag("--json", a->json, "Print JSON");
  command->callback([a, &status] { status.exitCode = stabilityCommand(*a); });
}

}  // namespace ltcfit::app
