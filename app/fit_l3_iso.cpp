// ltcfit fit iso --fitter l3: Nelder-Mead with warm starts along the table.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/fit_output.h"
#include "app/fit_runs.h"
#include "app/fit_summary.h"
#include "app/progress.h"
#include "export/atomic_file.h"

namespace ltcfit::app {
namespace {

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

Summary relativeErrors(const IsotropicFitResult& result) {
  std::vector<double> errors;
  for (const EntryReport& r : result.reports) errors.push_back(r.fit.relativeL3);
  return summarize(std::move(errors));
}

void printText(const IsotropicFitResult& result, const Times& times) {
  const Summary relative = relativeErrors(result);
  fmt::print("{} entries, {} evaluations: {:.1f} CPU s, {:.1f} s wall\n", result.reports.size(),
             result.evaluations, times.cpu, times.wall);
  fmt::print("tried again {}, better for it {}; not converged {}, unusable {}\n", result.refitted,
             result.improvedByRefit, result.notConverged, result.unusable);
  fmt::print(
      "relative L3 error of the fit: mean {:.4f}, p99 {:.4f}, max {:.4f}; norm and Fresnel within {:.0e}\n",
      relative.mean, relative.p99, relative.max, result.largestMomentError);
}

nlohmann::ordered_json toJson(const FitArguments& a, const IsotropicFitResult& result, const Times& times) {
  const Summary relative = relativeErrors(result);
  return {{"output", a.output},
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
}

}  // namespace

int fitIsotropicL3(const FitArguments& a, const IsotropicTableOptions& tableOptions) {
  IsotropicFitOptions options;
  options.table = tableOptions;
  options.entry = toFitOptions(a).l3;
  options.threads = a.threads;
  std::string error;
  if (!options.isValid(&error)) throw InputError(error);

  checkRefinement(a);
  const Stopwatch watch;
  IsotropicFitResult result;
  {
    Progress progress("fit", a.quiet);
    result = fitIsotropicTable(options,
                               [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  }
  const Times times = watch.elapsed();
  result.info.provenance = makeProvenance(a);
  if (!a.reportPath.empty()) writeFileAtomically(a.reportPath, reportCsv(result));
  std::optional<FitOutput> output;
  if (result.unusable == 0) output = writeFit(Table(result.info, result.data), a);
  const std::unique_ptr<Score> score = output ? scoreFit(output->table, a) : nullptr;
  if (a.json) {
    nlohmann::ordered_json out = toJson(a, result, times);
    if (output) addFitOutput(*output, &out);
    addLookup(summarizeLookup(result.info), &out);
    if (score) addScore(*score, &out);
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else if (!a.quiet) {
    printText(result, times);
    if (output) printFitOutput(*output, a);
    printLookup(summarizeLookup(result.info));
    if (score) printScore(*score, a);
  }
  return output ? exitCodeOf(*output) : refuseUnusable(result.unusable, a);
}

}  // namespace ltcfit::app
