// ltcfit report: one page about a table or two.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>

#include "app/commands.h"
#include "app/memory.h"
#include "app/metric_arguments.h"
#include "app/notes.h"
#include "app/paths.h"
#include "app/progress.h"
#include "app/shell_quoted.h"
#include "app/table_arguments.h"
#include "base/refusal.h"
#include "export/atomic_file.h"
#include "export/read_table.h"
#include "report/measurement_files.h"
#include "report/page.h"
#include "report/report_json.h"
#include "report/shading_file.h"

namespace ltcfit::app {
namespace {

// Every metric at every node goes into the page: 256 x 256, or 16^4.
constexpr std::size_t kMostNodes = 65536;

struct ReportArguments {
  std::vector<std::string> tables;
  ReadOptions input;
  std::vector<std::string> against;
  std::vector<std::string> pareto;
  std::vector<std::string> shading;
  std::string stability;
  std::string output = "report.html";
  std::string storedAs = "auto";
  std::int64_t points = 512;
  std::int64_t seed = 1;
  MetricOptions metrics;
  int threads = 0;
  bool gate = false;
  bool quiet = false;
};

// Beside the page, by the same name.
std::string jsonPath(const std::string& page) {
  return std::filesystem::path(page).replace_extension(".json").string();
}

void checkOutputs(const ReportArguments& a) {
  const std::string json = jsonPath(a.output);
  if (json == a.output) throw InputError(a.output + ": the page needs another name: its JSON gets this one");
  std::vector<std::string> inputs = a.pareto;
  inputs.insert(inputs.end(), a.shading.begin(), a.shading.end());
  if (!a.stability.empty()) inputs.push_back(a.stability);
  const auto add = [&](const std::string& path, const ReadOptions& read) {
    const std::vector<std::string> files = filesOfTable(path, read);
    inputs.insert(inputs.end(), files.begin(), files.end());
  };
  for (const std::string& path : a.tables) add(path, a.input);
  for (const std::string& path : a.against) add(path, {});
  for (const std::string& output : {a.output, json}) {
    if (isStream(output)) throw InputError(output + ": not a file; two are written, side by side");
    checkWritable(output);
    for (const std::string& input : inputs)
      if (isSameFile(output, input)) throw InputError(output + ": would overwrite this input");
  }
  if (isSameFile(a.output, json)) throw InputError(a.output + ": the same file as " + json);
}

// What a shader interpolates. Isotropic tables are read as the inverse over its middle element, unless a node
// has none: then, as for anisotropic ones, what the file holds.
Table asRead(const ReportArguments& a, const std::string& path, const Table& file) {
  const TableInfo& info = file.info();
  const bool shaders = a.storedAs == "auto" && file.isIsotropic();
  if (a.storedAs == "file" || (a.storedAs == "auto" && !shaders)) return file;
  const bool inverse = shaders || a.storedAs == "Minv";
  const MatrixStorage stores = inverse ? MatrixStorage::kMinv : MatrixStorage::kM;
  const MatrixNormalization normalization =
      inverse ? MatrixNormalization::kMiddleElement : MatrixNormalization::kThirdColumnUnit;
  if (info.stores == stores && info.normalization == normalization) return file;
  try {
    return storedAs(file, stores, normalization);
  } catch (const Refusal& error) {
    if (shaders) return file;
    throw InputError(path + ": --stored-as " + a.storedAs + ": " + error.what());
  }
}

ReportTable readReportTable(const ReportArguments& a, const std::string& path, const ReadOptions& input) {
  Table file = readInput(path, input).table;
  if (file.nodeCount() > kMostNodes)
    throw InputError(
        fmt::format("{}: {} nodes; a report shows {} at most", path, file.nodeCount(), kMostNodes));
  Table read = asRead(a, path, file);
  return {fileName(path), std::move(file), std::move(read)};
}

// The page tells tables apart by name.
void makeNamesDifferent(std::vector<ReportTable>& tables) {
  for (std::size_t t = 1; t < tables.size(); ++t) {
    const std::string name = tables[t].name;
    const auto taken = [&] {
      return std::any_of(tables.begin(), tables.begin() + static_cast<std::ptrdiff_t>(t),
                         [&](const ReportTable& other) { return other.name == tables[t].name; });
    };
    for (int i = 2; taken(); ++i) tables[t].name = fmt::format("{} ({})", name, i);
  }
}

// One group for each table: the table, then what it is held against.
std::vector<std::vector<ReportTable>> readGroups(const ReportArguments& a) {
  std::vector<std::vector<ReportTable>> groups;
  for (const std::string& path : a.tables) {
    groups.push_back({readReportTable(a, path, a.input)});
    if (groups.size() == 2 && groups[0][0].file.isIsotropic() == groups[1][0].file.isIsotropic())
      throw InputError(fmt::format("{}: a second {} table; --against holds one against another", path,
                                   groups[0][0].file.isIsotropic() ? "isotropic" : "anisotropic"));
  }
  for (const std::string& path : a.against) {
    ReportTable reference = readReportTable(a, path, {});
    const bool isotropic = reference.file.isIsotropic();
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const std::vector<ReportTable>& g) {
      return g[0].file.isIsotropic() == isotropic;
    });
    if (group == groups.end())
      throw InputError(fmt::format("{}: an {} table, and no table of that kind to hold against it", path,
                                   isotropic ? "isotropic" : "anisotropic"));
    group->push_back(std::move(reference));
  }
  for (std::vector<ReportTable>& group : groups) makeNamesDifferent(group);
  return groups;
}

Json readPareto(const ReportArguments& a) {
  Json out = Json::array();
  for (const std::string& path : a.pareto) {
    out.push_back(paretoFromJson(readFile(path, kMeasurementBytes), path));
    if (out.size() == 2 && out[0]["table"] == out[1]["table"])
      throw InputError(
          fmt::format("{}: table: a second file about '{}'", path, out[1]["table"].get<std::string>()));
  }
  return out;
}

// At most one file for each kind of table.
Json readShading(const ReportArguments& a) {
  Json out = Json::array();
  for (const std::string& path : a.shading) {
    Json file = shadingFromJson(readFile(path, kShadingBytes), path);
    for (const Json& other : out)
      if (other["table"]["isotropic"] == file["table"]["isotropic"])
        throw InputError(fmt::format("{}: table: a second file about an {} table", path,
                                     file["table"]["isotropic"].get<bool>() ? "isotropic" : "anisotropic"));
    out.push_back(std::move(file));
  }
  return out;
}

// The same file again, from wherever the inputs lie: names without folders, no threads.
std::string commandOf(const ReportArguments& a) {
  std::string out = "ltcfit report";
  for (const std::string& path : a.tables) out += " " + shellFileName(path);
  out += tableInputText(a.input);
  for (const std::string& path : a.against) out += " --against " + shellFileName(path);
  for (const std::string& path : a.pareto) out += " --pareto " + shellFileName(path);
  for (const std::string& path : a.shading) out += " --shading " + shellFileName(path);
  if (!a.stability.empty()) out += " --stability " + shellFileName(a.stability);
  const ReportArguments standard;
  const auto option = [&](const char* name, const auto& value, const auto& usual) {
    if (value != usual) out += fmt::format(" --{} {}", name, shellQuoted(fmt::format("{}", value)));
  };
  option("points", a.points, standard.points);
  option("stored-as", a.storedAs, standard.storedAs);
  option("samples", a.metrics.samples, standard.metrics.samples);
  option("directions", a.metrics.directions, standard.metrics.directions);
  option("quads", a.metrics.quads, standard.metrics.quads);
  option("lights", a.metrics.lights, standard.metrics.lights);
  option("seed", a.seed, standard.seed);
  return out;
}

// --quiet leaves out the summary, but not why a gate fails.
std::string verdictLines(const ReportArguments& a, const std::string& name,
                         const std::vector<Verdict>& verdicts) {
  const auto passed =
      std::count_if(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.passes(); });
  if (a.quiet && (!a.gate || passed == std::ssize(verdicts))) return {};
  std::string out = fmt::format("{}: {} of {} limits are kept\n", name, passed, verdicts.size());
  for (const Verdict& v : verdicts) {
    if (!v.passes())
      out += fmt::format("  not kept: {}: {:.4g}, limit {:.4g}{}{}\n", v.what, v.value, v.limit,
                         v.detail.empty() ? "" : "; ", v.detail);
  }
  return out;
}

int report(const ReportArguments& a) {
  const PageParts page = builtInPage();
  if (page.charts.empty())
    throw std::runtime_error(
        "this build has no charting library for the page; with npm and a network, `cmake build && cmake "
        "--build "
        "build` fetches it, and `cmake -DLTCFIT_ECHARTS=FILE build` takes an echarts.min.js that is there");
  if (a.tables.size() > 1 && !a.input.second.empty())
    throw InputError("--second belongs to one table: give one, and the other in a run of its own");
  checkOutputs(a);
  std::vector<std::vector<ReportTable>> groups = readGroups(a);
  ReportSettings settings;
  settings.options.metrics = a.metrics;
  settings.options.metrics.seed = static_cast<std::uint64_t>(a.seed);
  settings.options.points = static_cast<std::size_t>(a.points);
  settings.options.threads = a.threads;
  for (const std::vector<ReportTable>& group : groups) {
    ScoreOptions options;  // of all three sets
    options.set = PointSet::kOffGrid;
    options.count = group[0].file.nodeCount() + 2 * settings.options.points;
    options.metrics = a.metrics;
    options.threads = a.threads;
    requireMemory(scoreBytes(group[0].file, group.size(), options),
                  fmt::format("report: {} samples, {} directions and {} lights on each thread, and {} points",
                              a.metrics.samples, a.metrics.directions, a.metrics.lights, options.count),
                  "lower --points, --samples, --directions, --lights or --threads");
  }
  settings.storedAs = a.storedAs;
  settings.command = commandOf(a);
  Json out = reportHead(settings);
  out["shading"] = readShading(a);
  out["pareto"] = readPareto(a);
  if (!a.stability.empty())
    out["stability"] = stabilityFromJson(readFile(a.stability, kMeasurementBytes), a.stability);

  Json images = Json::object();
  std::string title;
  std::string notes;
  bool kept = true;
  for (const std::vector<ReportTable>& group : groups) {
    Progress progress(group[0].name, a.quiet);
    const TableReport result = reportTable(
        group, settings.options, [&](std::size_t done, std::size_t total) { progress.update(done, total); });
    out["tables"].push_back(tableReportJson(group, result, out["tables"].size(), images));
    title += (title.empty() ? "" : ", ") + group[0].name;
    kept = kept && std::all_of(result.verdicts.begin(), result.verdicts.end(),
                               [](const Verdict& v) { return v.passes(); });
    notes += verdictLines(a, group[0].name, result.verdicts);
  }
  const auto text = [](const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  const std::string json = text(out);
  // the page first: it is the larger one, and where it does not fit, the old pair stays
  writeFileAtomically(a.output, fillPage(page, title, json, text(images)));
  writeFileAtomically(jsonPath(a.output), json + "\n");
  if (!a.quiet) notes += fmt::format("{}, {}\n", a.output, jsonPath(a.output));
  printNotes(a.quiet ? NotesTo::kStderr : NotesTo::kStdout, notes);
  return a.gate && !kept ? kExitQuality : kExitOk;
}

}  // namespace

void addReportCommand(CLI::App& app, CommandStatus& status) {
  CLI::App* const command = app.add_subcommand(
      "report", "One HTML page about a table or two: errors, maps, lobes, smoothness, limits; and its JSON");
  auto a = std::make_shared<ReportArguments>();
  command->add_option("TABLE", a->tables, "An isotropic table, an anisotropic one, or one of each")
      ->required()
      ->expected(1, 2)
      ->type_name("FILE");
  addTableInput(*command, a->input);
  command
      ->add_option("--against", a->against,
                   "A table to hold the one of its kind against; may be given more than once")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      ->add_option("--pareto", a->pareto,
                   "What `ltcfit pareto` wrote, to show error against run time; one for each kind of table")
      ->type_name("FILE.json")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--shading", a->shading,
          "The shading.json that `ltcfit check-gl -o` wrote: rendered scenes against the reference; one for "
          "each kind of table")
      ->type_name("FILE.json")
      ->allow_extra_args(false);
  command->add_option("--stability", a->stability, "What `ltcfit stability` wrote")->type_name("FILE.json");
  command
      ->add_option("-o,--output", a->output,
                   "The page; one file that needs no other. Its JSON goes beside it, ending in .json")
      ->type_name("FILE.html")
      ->capture_default_str();
  command
      ->add_option(
          "--stored-as", a->storedAs,
          "What is interpolated between nodes: auto = the inverse over its middle element for isotropic "
          "tables, as\nshaders read them, what the file holds for anisotropic ones; file, M, Minv: for both")
      ->check(CLI::IsMember({"auto", "file", "M", "Minv"}))
      ->capture_default_str();
  command
      ->add_option("--points", a->points,
                   "Number of points off-grid, and of extreme ones; nodes are all taken")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1000000}))
      ->capture_default_str();
  command->add_option("--seed", a->seed, "Seed of points, samples and lights, 0..2^53")
      ->check(CLI::Range(std::int64_t{0}, kLargestSeed))
      ->capture_default_str();
  addMetricOptions(*command, a->metrics);
  command->add_option("--threads", a->threads, "Threads; 0 = all cores. Does not change the result")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_flag("--gate", a->gate, "Exit 3 where a table does not keep a limit");
  command->add_flag("-q,--quiet", a->quiet,
                    "No progress line, no summary; --gate still names the limits not kept, on stderr");
  command->callback([a, &status] { status.exitCode = report(*a); });
}

}  // namespace ltcfit::app
