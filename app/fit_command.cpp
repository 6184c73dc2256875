// ltcfit fit iso: the isotropic table.
#include <fmt/format.h>
#include <time.h>

#include <array>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/commands.h"
#include "app/progress.h"
#include "export/atomic_file.h"
#include "export/json_table.h"
#include "fit/isotropic_table_fit.h"
#include "report/score.h"

namespace ltcfit::app {
namespace {

struct FitArguments {
  std::string output;
  std::string reportPath;
  std::string size = "64x64";
  std::string axes = "2017";
  std::string fitter = "l3";
  std::string family = "4";
  int samples = EntryFitOptions{}.samples;
  double alphaFloor = IsotropicFitOptions{}.alphaFloor;
  double thetaMax = IsotropicFitOptions{}.thetaMax;
  int maxEvaluations = NelderMeadOptions{}.maxEvaluations;
  int threads = 0;
  std::int64_t seed = 1;
  int scorePoints = 64;
  bool quiet = false;
  bool json = false;
};

// "64x32" to {64, 32}; std::invalid_argument otherwise.
std::array<std::size_t, 2> parseSize(const std::string& text) {
  std::array<std::size_t, 2> out{};
  int used = 0;
  unsigned a = 0;
  unsigned b = 0;
  const bool plain = text.find_first_not_of("0123456789x") == std::string::npos && text.size() < 12;
  if (!plain || std::sscanf(text.c_str(), "%ux%u%n", &a, &b, &used) != 2 ||
      used != static_cast<int>(text.size())) {
    throw std::invalid_argument("--size '" + text + "': need THETAxALPHA, for example 64x64");
  }
  out = {a, b};
  return out;
}

IsotropicFitOptions toOptions(const FitArguments& a) {
  IsotropicFitOptions o;
  const std::array<std::size_t, 2> size = parseSize(a.size);
  o.thetaNodes = size[0];
  o.alphaNodes = size[1];
  o.axes = a.axes == "2016" ? IsotropicAxes::k2016 : IsotropicAxes::k2017;
  o.alphaFloor = a.alphaFloor;
  o.thetaMax = a.thetaMax;
  o.threads = a.threads;
  o.entry.nelderMead.maxEvaluations = a.maxEvaluations;
  o.entry.family = a.family == "3" ? IsotropicFamily::kMeanFrame3 : IsotropicFamily::kPlane4;
  o.entry.samples = a.samples;
  o.entry.seed = static_cast<std::uint64_t>(a.seed);
  std::string error;
  if (!o.isValid(&error)) throw std::invalid_argument(error);
  return o;
}

// The command that gives the same bytes: every option that matters, none that does not (threads, paths).
Provenance makeProvenance(const FitArguments& a) {
  Provenance p;
  p.tool = "ltcfit";
  p.toolVersion = LTCFIT_VERSION;
  p.command =
      fmt::format("ltcfit fit iso --size {} --axes {} --fitter {} --family {} --samples {} --alpha-floor {}",
                  a.size, a.axes, a.fitter, a.family, a.samples, a.alphaFloor);
  if (a.thetaMax != IsotropicFitOptions{}.thetaMax) p.command += fmt::format(" --theta-max {}", a.thetaMax);
  if (a.maxEvaluations != NelderMeadOptions{}.maxEvaluations) {
    p.command += fmt::format(" --max-evaluations {}", a.maxEvaluations);
  }
  p.command += fmt::format(" --seed {}", a.seed);
  p.seed = a.seed;
  p.options = {{"size", a.size},
               {"axes", a.axes},
               {"fitter", a.fitter},
               {"family", a.family},
               {"samples", std::int64_t{a.samples}},
               {"alpha_floor", a.alphaFloor},
               {"theta_max", a.thetaMax},
               {"max_evaluations", std::int64_t{a.maxEvaluations}}};
  return p;
}

std::string reportCsv(const IsotropicFitResult& result) {
  std::string out =
      "theta,alpha,warm_start,termination,evaluations,total_evaluations,start_cost,cost,relative_l3,refitted,"
      "improved,usable\n";
  const std::size_t alphas = result.info.axes[1].size();
  for (std::size_t i = 0; i < result.reports.size(); ++i) {
    const EntryReport& r = result.reports[i];
    fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},{},{},{},{:d},{:d},{:d}\n",
                   result.info.axes[0].values[i / alphas], result.info.axes[1].values[i % alphas],
                   warmStartName(r.warmStart), terminationName(r.fit.termination), r.fit.evaluations,
                   r.totalEvaluations, r.fit.startCost, r.fit.cost, r.fit.relativeL3, r.refitted, r.improved,
                   r.usable);
  }
  return out;
}

struct Times {
  double cpu = 0.0;
  double wall = 0.0;
};

Summary relativeErrors(const IsotropicFitResult& result) {
  std::vector<double> errors;
  for (const EntryReport& r : result.reports) errors.push_back(r.fit.relativeL3);
  return summarize(std::move(errors));
}

constexpr std::array<Metric, 7> kSummaryMetrics{Metric::kSw1,    Metric::kForm,   Metric::kLightS,
                                                Metric::kLightM, Metric::kLightL, Metric::kTv,
                                                Metric::kBelow};

void printText(const FitArguments& a, const IsotropicFitResult& result, const Times& times,
               const Score* score) {
  const Summary relative = relativeErrors(result);
  fmt::print("{} entries, {} evaluations: {:.1f} CPU s, {:.1f} s wall\n", result.reports.size(),
             result.evaluations, times.cpu, times.wall);
  fmt::print("tried again {}, better for it {}; not converged {}, unusable {}\n", result.refitted,
             result.improvedByRefit, result.notConverged, result.unusable);
  fmt::print(
      "relative L3 error of the fit: mean {:.4f}, p99 {:.4f}, max {:.4f}; norm and Fresnel within {:.0e}\n",
      relative.mean, relative.p99, relative.max, result.largestMomentError);
  if (score != nullptr) {
    fmt::print("off-grid at {} points, fetched as shaders read the exported header, on unseen samples:\n",
               score->points);
    for (Metric m : kSummaryMetrics) {
      const Summary& s = score->summary[static_cast<std::size_t>(m)];
      fmt::print("  {:<8} mean {:.5f}  p99 {:.5f}\n", metricName(m), s.mean, s.p99);
    }
  }
  if (result.unusable == 0) fmt::print("wrote {}\n", a.output);
}

void printJson(const FitArguments& a, const IsotropicFitResult& result, const Times& times,
               const Score* score) {
  const Summary relative = relativeErrors(result);
  nlohmann::ordered_json out{
      {"output", a.output},
      {"entries", result.reports.size()},
      {"evaluations", result.evaluations},
      {"cpu_seconds", times.cpu},
      {"wall_seconds", times.wall},
      {"refitted", result.refitted},
      {"improved_by_refit", result.improvedByRefit},
      {"not_converged", result.notConverged},
      {"unusable", result.unusable},
      {"moment_error", result.largestMomentError},
      {"relative_l3", {{"mean", relative.mean}, {"p99", relative.p99}, {"max", relative.max}}}};
  if (score != nullptr) {
    for (Metric m : kSummaryMetrics) {
      const Summary& s = score->summary[static_cast<std::size_t>(m)];
      out["off_grid"][metricName(m)] = {{"mean", s.mean}, {"p99", s.p99}};
    }
  }
  fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

int fitIso(const FitArguments& a) {
  const IsotropicFitOptions options = toOptions(a);
  checkWritable(a.output);
  if (!a.reportPath.empty()) checkWritable(a.reportPath);
  if (a.reportPath == a.output) throw InputError(a.output + ": --output and --report name the same file");

  const auto wallStart = std::chrono::steady_clock::now();
  const double cpuStart = cpuSeconds();
  IsotropicFitResult result;
  {
    Progress progress("fit", a.quiet);
    result = fitIsotropicTable(options,
                               [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  }
  const Times times{cpuSeconds() - cpuStart,
                    std::chrono::duration<double>(std::chrono::steady_clock::now() - wallStart).count()};

  result.info.provenance = makeProvenance(a);
  if (!a.reportPath.empty()) writeFileAtomically(a.reportPath, reportCsv(result));
  std::unique_ptr<Score> score;
  if (result.unusable == 0) {
    const Table table(result.info, result.data);
    writeFileAtomically(a.output, tableToJson(table));
    if (a.scorePoints > 0 && (!a.quiet || a.json)) {
      ScoreOptions scoring;
      scoring.set = PointSet::kOffGrid;
      scoring.count = static_cast<std::size_t>(a.scorePoints);
      scoring.metrics.seed = static_cast<std::uint64_t>(a.seed) + 1;
      scoring.threads = a.threads;
      // as the header is read: shaders interpolate the inverse
      const Table read = storedAs(table, MatrixStorage::kMinv, MatrixNormalization::kMiddleElement);
      score = std::make_unique<Score>(scoreTables({&read}, scoring)[0]);
    }
  }
  if (a.json) {
    printJson(a, result, times, score.get());
  } else if (!a.quiet) {
    printText(a, result, times, score.get());
  }
  if (result.unusable > 0) {
    fmt::print(stderr,
               "ltcfit: {} entries are unusable (singular, or worse than no light): nothing was written{}\n",
               result.unusable, a.reportPath.empty() ? "; --report FILE.csv lists them" : "");
    return kExitQuality;
  }
  return kExitOk;
}

}  // namespace

double cpuSeconds() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void addFitCommand(CLI::App& app, CommandStatus& status) {
  CLI::App* const fit = app.add_subcommand("fit", "Fit a table");
  fit->require_subcommand(1);
  CLI::App* const iso = fit->add_subcommand("iso", "Fit the isotropic table (theta, alpha)");
  auto a = std::make_shared<FitArguments>();
  iso->add_option("-o,--output", a->output, "Table file to write (JSON)")->required()->type_name("FILE.json");
  iso->add_option(
         "--size", a->size,
         "Nodes along theta and alpha, 2..1024; alpha up to 100 with the default floor, 317 with 1e-5")
      ->type_name("THETAxALPHA")
      ->capture_default_str();
  iso->add_option(
         "--axes", a->axes,
         "Axes: 2017 = sqrt(1 - cos theta), what engines read; 2016 = theta, linear. Both with sqrt(alpha)")
      ->check(CLI::IsMember({"2016", "2017"}))
      ->capture_default_str();
  iso->add_option("--fitter", a->fitter, "l3: Nelder-Mead on the L3 error (Heitz et al. 2016)")
      ->check(CLI::IsMember({"l3"}))
      ->capture_default_str();
  iso->add_option("--family", a->family,
                  "Free parameters of a matrix: 4 = [a 0 b; 0 c 0; d 0 1] (the paper, eq. 6);\n"
                  "3 = in the frame of the mean direction (its authors' code, the 2017 table)")
      ->check(CLI::IsMember({"3", "4"}))
      ->capture_default_str();
  iso->add_option("--samples", a->samples,
                  "Directions of the lobe, and as many of the LTC, for the error; 16..4194304")
      ->capture_default_str();
  iso->add_option("--max-evaluations", a->maxEvaluations,
                  "Evaluations of the error for one try at one entry, 1..1000000")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  iso->add_option("--alpha-floor", a->alphaFloor,
                  "GGX alpha of the nodes at sqrt(alpha) = 0; 1e-5 to below the second node's")
      ->capture_default_str();
  iso->add_option("--theta-max", a->thetaMax,
                  "View angle of the last row, radians; up to pi/2, which needs no clamp (2017 table: 1.57)")
      ->type_name("RAD")
      ->default_str("pi/2");
  iso->add_option("--seed", a->seed, "Seed of the sample points, 0..2^53")
      ->check(CLI::Range(std::int64_t{0}, kLargestSeed))
      ->capture_default_str();
  iso->add_option("--threads", a->threads, "Threads; 0 = all cores. Does not change the result")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  iso->add_option("--report", a->reportPath,
                  "Also write a CSV with one line for each entry: start, cost, evaluations, why it stopped")
      ->type_name("FILE.csv");
  iso->add_option("--score-points", a->scorePoints, "Points of the error figures in the summary; 0 = none")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  iso->add_flag("-q,--quiet", a->quiet, "Print nothing but errors");
  iso->add_flag("--json", a->json, "Print the summary as JSON");
  iso->callback([a, &status] { status.exitCode = fitIso(*a); });
}

}  // namespace ltcfit::app
