// ltcfit pareto: error against CPU time, of every fitter at several efforts.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/metric_arguments.h"
#include "app/progress.h"
#include "app/shell_quoted.h"
#include "export/atomic_file.h"
#include "report/pareto.h"
#include "report/pareto_json.h"
#include "report/pareto_text.h"

namespace ltcfit::app {
namespace {

struct ParetoArguments {
  std::string table = "aniso";
  std::string output;
  std::int64_t entries = static_cast<std::int64_t>(ParetoOptions{}.entries);
  std::int64_t repeats = static_cast<std::int64_t>(ParetoOptions{}.repeats);
  std::int64_t seed = static_cast<std::int64_t>(ParetoOptions{}.seed);
  std::vector<std::string> fitters;
  MetricOptions metrics = ParetoOptions{}.metrics;
  int threads = 0;
  bool quiet = false;
  bool json = false;
};

ParetoOptions toOptions(const ParetoArguments& a) {
  ParetoOptions o;
  o.kind = a.table == "iso" ? TableKind::kIsotropic : TableKind::kAnisotropic;
  o.entries = static_cast<std::size_t>(a.entries);
  o.repeats = static_cast<std::size_t>(a.repeats);
  o.seed = static_cast<std::uint64_t>(a.seed);
  o.fitters = a.fitters;
  o.metrics = a.metrics;
  o.threads = a.threads;
  return o;
}

// Every option that the errors follow from.
std::string commandOf(const ParetoArguments& a) {
  std::string out = fmt::format(
      "ltcfit pareto --table {} --entries {} --repeats {} --seed {} --samples {} --directions {} --quads {} "
      "--lights {}",
      shellQuoted(a.table), a.entries, a.repeats, a.seed, a.metrics.samples, a.metrics.directions,
      a.metrics.quads, a.metrics.lights);
  for (const std::string& fitter : a.fitters) out += " --fitter " + shellQuoted(fitter);
  return out;
}

std::string milliseconds(double seconds) {
  const double ms = 1e3 * seconds;
  return fmt::format("{:.{}f}", ms, ms < 9.995 ? 2 : ms < 99.95 ? 1 : 0);
}

void printTable(const ParetoArguments& a, const ParetoResult& result) {
  fmt::print(
      "{} {} entries, {} repeats, seed {}; {} samples, {} directions, {} quads, {} lights of each size\n"
      "CPU ms an entry: median over repeats, smallest and largest. Errors: over the best of any fit of an "
      "entry,\n"
      "geometric mean over entries (median over repeats); * = no other setting is as fast and as good, at "
      "the "
      "entries\nthat both have\n\n",
      a.entries, a.table == "iso" ? "isotropic" : "anisotropic", a.repeats, a.seed, a.metrics.samples,
      a.metrics.directions, a.metrics.quads, a.metrics.lights);
  std::size_t width = 0;
  for (const FitSetting& s : result.settings) width = std::max(width, settingLabel(s).size());
  fmt::print("{:<{}}{:>9}{:>9}{:>18}", "", width, "fits", "CPU ms", "");
  for (const ParetoMetric& m : paretoMetrics()) fmt::print("{:>9} ", m.name);
  fmt::print("\n");
  for (std::size_t s = 0; s < result.settings.size(); ++s) {
    const SettingSummary& summary = result.summaries[s];
    const Spread& seconds = summary.cpuSeconds;
    fmt::print("{:<{}}{:>9}{:>9}{:>18}", settingLabel(result.settings[s]), width,
               fmt::format("{} x {}", summary.entries, summary.runs / summary.entries),
               milliseconds(seconds.median),
               fmt::format("({}..{})", milliseconds(seconds.low), milliseconds(seconds.high)));
    for (const SettingErrors& e : summary.errors) {
      fmt::print("{:>9}{}", std::isfinite(e.ratio.median) ? fmt::format("{:.3f}", e.ratio.median) : "-",
                 e.front ? '*' : ' ');
    }
    if (summary.nonFinite > 0) fmt::print(" {} failed", summary.nonFinite);
    fmt::print("\n");
  }
}

int paretoCommand(const ParetoArguments& a) {
  if (!a.output.empty()) checkWritable(a.output);
  const ParetoOptions options = toOptions(a);
  ParetoResult result;
  {
    Progress progress("pareto, nominal CPU s", a.quiet);
    result = runPareto(options, [&](double done, double total) {
      progress.update(static_cast<std::size_t>(std::ceil(done)), static_cast<std::size_t>(std::ceil(total)));
    });
  }
  const nlohmann::ordered_json json = paretoToJson(options, result, commandOf(a));
  const std::string text = json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
  if (!a.output.empty()) {
    writeFileAtomically(a.output, text);
    if (isStream(a.output)) return kExitOk;  // what goes to a stream is the data alone
  }
  if (a.json) {
    fmt::print("{}", text);
    return kExitOk;
  }
  printTable(a, result);
  for (const ParetoDefault& d : explainDefaults(options.kind, result))
    fmt::print("\nltcfit {}: {}\n", d.command, d.why);
  return kExitOk;
}

}  // namespace

void addParetoCommand(CLI::App& app, CommandStatus& status) {
  CLI::App* const command = app.add_subcommand(
      "pareto", "Error against CPU time: every fitter at several efforts, and where the defaults stand");
  auto a = std::make_shared<ParetoArguments>();
  command->add_option("-o,--output", a->output, "Also write the figures as JSON")->type_name("FILE.json");
  command
      ->add_option("--table", a->table,
                   "What is fitted: aniso = anisotropic lobes to 100:1, with the settings of fit aniso;\n"
                   "iso = isotropic ones, with those of fit iso")
      ->check(CLI::IsMember({"iso", "aniso"}))
      ->capture_default_str();
  command
      ->add_option("--entries", a->entries,
                   "Number of entries, sharp to rough, normal to grazing; costly settings run on fewer; "
                   "1..1000")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1000}))
      ->capture_default_str();
  command->add_option("--repeats", a->repeats, "Fits of each entry, each with a seed of its own; 1..100")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{100}))
      ->capture_default_str();
  command->add_option("--fitter", a->fitters, "Only this one; may be given more than once")
      ->check(CLI::IsMember({"moments", "light", "sw", "l3", "sw-sgd"}))
      ->default_str("all")
      ->allow_extra_args(false);
  command->add_option("--seed", a->seed, "Seed of the first repeat, and of samples and lights; 0..2^53")
      ->check(CLI::Range(std::int64_t{0}, kLargestSeed))
      ->capture_default_str();
  addMetricOptions(*command, a->metrics);
  command->add_option("--threads", a->threads, "Threads; 0 = all cores. Does not change the errors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_flag("-q,--quiet", a->quiet, "No progress line");
  command->add_flag("--json", a->json, "Print the JSON instead of the table");
  command->callback([a, &status] { status.exitCode = paretoCommand(*a); });
}

}  // namespace ltcfit::app
