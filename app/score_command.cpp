// ltcfit score: how far a table is from the lobes it stands for.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/memory.h"
#include "app/metric_arguments.h"
#include "app/progress.h"
#include "app/table_arguments.h"
#include "base/refusal.h"
#include "export/atomic_file.h"
#include "export/read_table.h"
#include "report/score.h"

namespace ltcfit::app {
namespace {

struct ScoreArguments {
  std::string table;
  ReadOptions input;
  std::vector<std::string> against;
  std::string points = "nodes";
  std::string storedAs = "file";
  std::string integrator = "exact";
  std::string reportPath;
  std::int64_t count = 512;
  std::int64_t seed = 1;
  double minAlpha = 0.0;
  MetricOptions metrics;
  int threads = 0;
  bool interpolation = false;
  bool quiet = false;
  bool json = false;
};

// The table as a shader would hold it: between nodes M and its inverse do not interpolate alike.
Table readForScore(const ScoreArguments& a, const std::string& path, const ReadOptions& input) {
  Table table = readInput(path, input).table;
  if (a.storedAs == "file") return table;
  try {
    const bool inverse = a.storedAs == "Minv";
    return ltcfit::storedAs(
        table, inverse ? MatrixStorage::kMinv : MatrixStorage::kM,
        inverse ? MatrixNormalization::kMiddleElement : MatrixNormalization::kThirdColumnUnit);
  } catch (const Refusal& error) {
    throw InputError(path + ": --stored-as " + a.storedAs + ": " + error.what());
  }
}

std::string describe(const Table& table) {
  std::string size;
  for (const Axis& axis : table.info().axes)
    size += fmt::format("{}{}", size.empty() ? "" : " x ", axis.size());
  const std::string& tool = table.info().provenance.tool;
  return fmt::format("{}, stores {}{}", size, matrixStorageName(table.info().stores),
                     tool == "ltcfit" || tool.empty() ? "" : "; " + tool);
}

std::string number(double v) {
  if (v == 0.0) return "0";
  return std::abs(v) >= 1e-3 && std::abs(v) < 1e4 ? fmt::format("{:.5f}", v) : fmt::format("{:.3e}", v);
}

void printSummaries(const Score& score) {
  fmt::print("{:<20}{:>11}{:>11}{:>11}{:>11}{:>11}{:>12}\n", "", "mean", "p50", "p90", "p99", "max",
             "non-finite");
  for (std::size_t m = 0; m < kMetricCount; ++m) {
    if (!score.present[m]) continue;
    const Summary& s = score.summary[m];
    fmt::print("{:<20}{:>11}{:>11}{:>11}{:>11}{:>11}{:>12}\n", metricName(static_cast<Metric>(m)),
               number(s.mean), number(s.p50), number(s.p90), number(s.p99), number(s.max), s.nonFinite);
  }
  fmt::print("singular matrices: {} in double, {} in float32\n", score.singular, score.singularFloat32);
  for (const std::string& note : score.notes) fmt::print("note: {}\n", note);
}

void printRatios(const Score& ours, const Score& theirs) {
  fmt::print("\nfirst / second      {:>11}{:>11}{:>11}{:>11}{:>11}\n", "mean", "p50", "p90", "p99", "max");
  const auto ratio = [](double a, double b) {
    return b > 0.0 ? fmt::format("{:.3f}", a / b) : std::string("-");
  };
  for (std::size_t m = 0; m < kMetricCount; ++m) {
    if (!ours.present[m] || !theirs.present[m]) continue;
    const Summary& a = ours.summary[m];
    const Summary& b = theirs.summary[m];
    fmt::print("{:<20}{:>11}{:>11}{:>11}{:>11}{:>11}\n", metricName(static_cast<Metric>(m)),
               ratio(a.mean, b.mean), ratio(a.p50, b.p50), ratio(a.p90, b.p90), ratio(a.p99, b.p99),
               ratio(a.max, b.max));
  }
}

// Largest ratio of SW1 at one point, which the ratio of the maxima hides; NaN without finite ratios.
double worstRatio(const Score& ours, const Score& theirs) {
  double worst = std::nan("");
  for (std::size_t i = 0; i < ours.all.size(); ++i) {
    const double ratio = ours.all[i].metrics.get(Metric::kSw1) / theirs.all[i].metrics.get(Metric::kSw1);
    if (std::isfinite(ratio)) worst = std::fmax(worst, ratio);
  }
  return worst;
}

// Means of more than two tables next to each other; the tables by number.
void printSideBySide(const ScoreArguments& a, const std::vector<Score>& scores) {
  fmt::print("\nmeans               ");
  for (std::size_t t = 0; t < scores.size(); ++t) fmt::print("{:>11}", fmt::format("[{}]", t + 1));
  fmt::print("   over [{}]:", scores.size());
  for (std::size_t t = 0; t + 1 < scores.size(); ++t) fmt::print("{:>11}", fmt::format("[{}]", t + 1));
  fmt::print("\n");
  for (std::size_t m = 0; m < kMetricCount; ++m) {
    const auto mean = [&](const Score& score) {
      return score.present[m] ? score.summary[m].mean : std::nan("");
    };
    const auto shown = [](double v, const std::string& text) {
      return std::isfinite(v) ? text : std::string("-");
    };
    if (std::none_of(scores.begin(), scores.end(), [&](const Score& s) { return s.present[m]; })) continue;
    fmt::print("{:<20}", metricName(static_cast<Metric>(m)));
    for (const Score& score : scores) fmt::print("{:>11}", shown(mean(score), number(mean(score))));
    fmt::print("           ");
    for (std::size_t t = 0; t + 1 < scores.size(); ++t) {
      const double ratio = mean(scores[t]) / mean(scores.back());
      fmt::print("{:>11}", shown(ratio, ratio < 1e4 ? fmt::format("{:.3f}", ratio) : number(ratio)));
    }
    fmt::print("\n");
  }
  fmt::print("[1] {}\n", a.table);
  for (std::size_t t = 1; t < scores.size(); ++t)
    fmt::print("[{}] {}; largest SW1 of [1] over its own at one point: {:.3f}\n", t + 1, a.against[t - 1],
               worstRatio(scores[0], scores[t]));
}

nlohmann::ordered_json toJson(const std::string& path, const Score& score) {
  nlohmann::ordered_json metrics = nlohmann::ordered_json::object();
  for (std::size_t m = 0; m < kMetricCount; ++m) {
    if (!score.present[m]) continue;
    const Summary& s = score.summary[m];
    metrics[metricName(static_cast<Metric>(m))] = {{"mean", s.mean},
                                                   {"p50", s.p50},
                                                   {"p90", s.p90},
                                                   {"p99", s.p99},
                                                   {"max", s.max},
                                                   {"count", s.count},
                                                   {"non_finite", s.nonFinite}};
  }
  nlohmann::ordered_json out{{"table", path},
                             {"singular", score.singular},
                             {"singular_float32", score.singularFloat32},
                             {"metrics", metrics}};
  if (!score.notes.empty()) out["notes"] = score.notes;
  return out;
}

// One line a point; columns of the other tables start with "against_", "against2_", ...
std::string reportCsv(const std::vector<Score>& scores) {
  std::string out = "alpha_x,alpha_y,theta,phi";
  for (std::size_t t = 0; t < scores.size(); ++t) {
    for (std::size_t m = 0; m < kMetricCount; ++m) {
      if (scores[t].present[m])
        fmt::format_to(std::back_inserter(out), ",{}{}",
                       t == 0   ? std::string()
                       : t == 1 ? std::string("against_")
                                : fmt::format("against{}_", t),
                       metricName(static_cast<Metric>(m)));
    }
  }
  out += "\n";
  for (std::size_t i = 0; i < scores[0].all.size(); ++i) {
    const LobeParameters& p = scores[0].all[i].parameters;
    fmt::format_to(std::back_inserter(out), "{},{},{},{}", p.alphaX, p.alphaY, p.theta, p.phi);
    for (const Score& score : scores) {
      for (std::size_t m = 0; m < kMetricCount; ++m) {
        if (score.present[m]) fmt::format_to(std::back_inserter(out), ",{}", score.all[i].metrics.value[m]);
      }
    }
    out += "\n";
  }
  return out;
}

int scoreCommand(const ScoreArguments& a) {
  if (!std::isfinite(a.minAlpha)) throw InputError("--min-alpha must be a number in 0..1");
  if (!a.reportPath.empty()) {
    checkWritable(a.reportPath);
    std::vector<std::string> inputs = filesOfTable(a.table, a.input);
    inputs.insert(inputs.end(), a.against.begin(), a.against.end());
    for (const std::string& input : inputs)
      if (isSameFile(a.reportPath, input)) throw InputError(input + ": --report would overwrite this table");
  }
  const Table table = readForScore(a, a.table, a.input);
  std::vector<Table> others;
  for (const std::string& path : a.against) {
    others.push_back(readForScore(a, path, {}));
    if (others.back().isIsotropic() != table.isIsotropic()) {
      throw InputError(path +
                       ": one table is isotropic, the other anisotropic: they have no points in common");
    }
  }
  ScoreOptions options;
  options.set = pointSetFromName(a.points);
  options.count = static_cast<std::size_t>(a.count);
  if (options.count == 0 && options.set != PointSet::kNodes) {
    throw InputError("--count 0 (all) needs --points nodes; give a number of points");
  }
  options.minAlpha = a.minAlpha;
  options.metrics = a.metrics;
  options.metrics.seed = static_cast<std::uint64_t>(a.seed);
  options.metrics.integrator =
      a.integrator == "exact" ? LightIntegrator::kExact : LightIntegrator::kProxySphere;
  options.interpolation = a.interpolation;
  options.threads = a.threads;
  requireMemory(scoreBytes(table, 1 + others.size(), options),
                fmt::format("score: {} samples, {} directions and {} lights on each thread, and {} points",
                            a.metrics.samples, a.metrics.directions, a.metrics.lights, a.count),
                "lower --count, --samples, --directions, --lights or --threads");
  std::vector<const Table*> tables{&table};
  for (const Table& other : others) tables.push_back(&other);

  std::vector<Score> scores;
  {
    Progress progress("score", a.quiet);
    scores = scoreTables(tables, options,
                         [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  }
  if (scores[0].points == 0) throw InputError(fmt::format("--min-alpha {}: no point is left", a.minAlpha));

  if (!a.reportPath.empty()) writeFileAtomically(a.reportPath, reportCsv(scores));
  if (a.json) {
    nlohmann::ordered_json out{{"points", a.points},           {"count", scores[0].points},
                               {"min_alpha", a.minAlpha},      {"seed", a.seed},
                               {"samples", a.metrics.samples}, {"directions", a.metrics.directions},
                               {"quads", a.metrics.quads},     {"lights", a.metrics.lights},
                               {"integrator", a.integrator},   {"stored_as", a.storedAs}};
    out["tables"] = {toJson(a.table, scores[0])};
    for (std::size_t t = 1; t < scores.size(); ++t) {
      out["tables"].push_back(toJson(a.against[t - 1], scores[t]));
      out["tables"].back()["worst_sw1_ratio_of_first"] = worstRatio(scores[0], scores[t]);
    }
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return kExitOk;
  }
  fmt::print("{} points{}, seed {}; {} samples, {} directions, {} quads, {} lights of each size{}\n\n",
             scores[0].points,
             a.points == "nodes" ? fmt::format(" of {} nodes", table.nodeCount()) : " " + a.points, a.seed,
             a.metrics.samples, a.metrics.directions, a.metrics.quads, a.metrics.lights,
             a.integrator == "exact" ? "" : " by proxy spheres");
  fmt::print("{} ({})\n", a.table, describe(table));
  printSummaries(scores[0]);
  for (std::size_t t = 1; t < scores.size(); ++t) {
    fmt::print("\n{} ({})\n", a.against[t - 1], describe(others[t - 1]));
    printSummaries(scores[t]);
  }
  if (scores.size() > 2) printSideBySide(a, scores);
  if (scores.size() == 2) {
    printRatios(scores[0], scores[1]);
    fmt::print("largest ratio of SW1 at one point: {:.3f}\n", worstRatio(scores[0], scores[1]));
    if (scores[1].otherParameters > 0) {
      fmt::print(
          "{} nodes of the second table were fitted at another theta or alpha (its clamps): there L3 and "
          "L3cost, which\n"
          "grow like alpha^-4/3 and alpha^-4, do not compare\n",
          scores[1].otherParameters);
    }
  }
  return kExitOk;
}

}  // namespace

void addScoreCommand(CLI::App& app, CommandStatus& status) {
  CLI::App* const command =
      app.add_subcommand("score", "Measure a table's error, alone or next to another one");
  auto a = std::make_shared<ScoreArguments>();
  command
      ->add_option("table", a->table,
                   "Table to score: ltcfit's JSON, or a published table (.npy, DDS; the first texture)")
      ->required()
      ->type_name("FILE");
  addTableInput(*command, a->input);
  command
      ->add_option("--against", a->against,
                   "Another table, scored at the same points; may be given more than once: then side by side")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--points", a->points,
          "nodes: the table's own; off-grid: random, fetched as a shader does;\nextreme: sharp and grazing")
      ->check(CLI::IsMember({"nodes", "off-grid", "extreme"}))
      ->capture_default_str();
  command
      ->add_option("--stored-as", a->storedAs,
                   "What is interpolated between nodes: file = what the file holds; Minv = the inverse over "
                   "its middle\n"
                   "element, as in the exported header and the shaders of engines; M = the matrix")
      ->check(CLI::IsMember({"file", "M", "Minv"}))
      ->capture_default_str();
  command
      ->add_option(
          "--integrator", a->integrator,
          "What the table's light integrals are computed by, in form and light_*: exact = clipped at the\n"
          "horizon; proxy-sphere = the shortcut of engines")
      ->check(CLI::IsMember({"exact", "proxy-sphere"}))
      ->capture_default_str();
  command->add_option("--count", a->count, "Number of points; 0 = all nodes")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{100000000}))
      ->capture_default_str();
  command
      ->add_option("--min-alpha", a->minAlpha,
                   "Leave out points with a smaller GGX alpha (the larger of alpha_x and alpha_y); 0..1")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--seed", a->seed, "Seed of points, samples and lights, 0..2^53")
      ->check(CLI::Range(std::int64_t{0}, kLargestSeed))
      ->capture_default_str();
  addMetricOptions(*command, a->metrics);
  command->add_flag("--interpolation", a->interpolation,
                    "Also fit each point directly, as the table was, and report the interpolation ratio");
  command->add_option("--report", a->reportPath, "Also write a CSV with one line for each point")
      ->type_name("FILE.csv");
  command->add_option("--threads", a->threads, "Threads; 0 = all cores. Does not change the result")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_flag("-q,--quiet", a->quiet, "No progress line");
  command->add_flag("--json", a->json, "Print JSON");
  command->callback([a, &status] { status.exitCode = scoreCommand(*a); });
}

}  // namespace ltcfit::app
