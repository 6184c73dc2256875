// ltcfit fit iso and fit aniso: every lobe on its own, then the table of them.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/fit_output.h"
#include "app/fit_runs.h"
#include "app/fit_summary.h"
#include "app/progress.h"
#include "base/diagnostics.h"
#include "base/refusal.h"
#include "export/atomic_file.h"
#include "fit/checkpoint.h"
#include "report/statistics.h"

namespace ltcfit::app {
namespace {

// The steps from fit to file, and what each does to the error.
struct Step {
  const char* name;
  const char* what;
  double JobResult::*loss;
};
constexpr std::array<Step, 5> kSteps{
    {{"start", "from moments of the samples", &JobResult::startLoss},
     {"fit", "", &JobResult::loss},
     {"alignment", "eq. 12; leaves the lobe as it is", &JobResult::alignedLoss},
     {"symmetry", "eq. 16", &JobResult::symmetricLoss},
     {"storage", "unit third column, float32", &JobResult::storedLoss}}};

Summary summarizeJobs(const TableFitResult& result, double JobResult::*field) {
  std::vector<double> values;
  for (const JobResult& job : result.jobs) values.push_back(job.*field);
  return summarize(std::move(values));
}

const char* familyLabel(MatrixFamily family) {
  static constexpr std::array<const char*, 5> kNames{"general", "mirror-y", "mirror-x", "mirror-xy",
                                                     "rotational"};
  return kNames[static_cast<std::size_t>(family)];
}

std::string reportCsv(const TablePlan& plan, const TableFitResult& result) {
  std::string out =
      "alpha_x,alpha_y,theta,phi,family,termination,evaluations,start_sw1,fit_sw1,aligned_sw1,symmetric_sw1,"
      "stored_sw1,alignment_before,alignment_after,alignment_strength,flip_closer,norm,fresnel,moment_error,"
      "integral_error,"
      "usable\n";
  std::vector<bool> usable(plan.jobs.size(), true);
  for (std::size_t n = 0; n < plan.nodes.size(); ++n)
    if (!result.nodeUsable[n]) usable[plan.nodes[n].job] = false;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const LobeParameters& p = plan.jobs[i].parameters;
    const JobResult& r = result.jobs[i];
    fmt::format_to(std::back_inserter(out),
                   "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{:d},{},{},{},{},{:d}\n", p.alphaX, p.alphaY,
                   p.theta, p.phi, familyLabel(plan.jobs[i].family), terminationName(r.termination),
                   r.evaluations, r.startLoss, r.loss, r.alignedLoss, r.symmetricLoss, r.storedLoss,
                   r.distanceBefore, r.distanceAfter, r.alignmentStrength, r.flipWouldBeCloser, r.norm,
                   r.fresnel, r.momentError, r.integralError, static_cast<bool>(usable[i]));
  }
  return out;
}

void printText(const FitArguments& a, const TablePlan& plan, const TableFitResult& result, const Times& times,
               std::size_t resumed) {
  fmt::print("{} lobes for {} nodes, {} evaluations: {:.1f} CPU s, {:.1f} s wall\n", plan.jobs.size(),
             plan.nodes.size(), result.evaluations, times.cpu, times.wall);
  if (resumed > 0) fmt::print("{} of the lobes are from the interrupted run\n", resumed);
  fmt::print("not converged {}, unusable {}, weakly aligned {}; norm and Fresnel within {:.0e}\n",
             result.notConverged, result.unusable, result.weaklyAligned, result.largestMomentError);
  if (a.fitter == "light")
    fmt::print("true light integrals within {:.0e} (estimated)\n", result.largestIntegralError);
  fmt::print("SW1 by the fit's own samples, after each step:\n");
  for (const Step& step : kSteps) {
    const Summary s = summarizeJobs(result, step.loss);
    fmt::print("  {:<10} mean {:.6f}  p99 {:.6f}  max {:.6f}  {}\n", step.name, s.mean, s.p99, s.max,
               step.what);
  }
  fmt::print("  alignment brings samples nearer: mean squared distance {:.4f} to {:.4f}\n",
             summarizeJobs(result, &JobResult::distanceBefore).mean,
             summarizeJobs(result, &JobResult::distanceAfter).mean);
}

nlohmann::ordered_json toJson(const FitArguments& a, const TablePlan& plan, const TableFitResult& result,
                              const Times& times, std::size_t resumed) {
  nlohmann::ordered_json out{{"output", a.output},
                             {"lobes", plan.jobs.size()},
                             {"nodes", plan.nodes.size()},
                             {"resumed", resumed},
                             {"evaluations", result.evaluations},
                             {"cpu_seconds", times.cpu},
                             {"wall_seconds", times.wall},
                             {"not_converged", result.notConverged},
                             {"unusable", result.unusable},
                             {"weakly_aligned", result.weaklyAligned},
                             {"moment_error", result.largestMomentError},
                             {"integral_error", result.largestIntegralError}};
  for (const Step& step : kSteps) {
    const Summary s = summarizeJobs(result, step.loss);
    out["sw1"][step.name] = {{"mean", s.mean}, {"p50", s.p50}, {"p99", s.p99}, {"max", s.max}};
  }
  out["alignment_distance"] = {{"before", summarizeJobs(result, &JobResult::distanceBefore).mean},
                               {"after", summarizeJobs(result, &JobResult::distanceAfter).mean}};
  return out;
}

// Where finished lobes are kept; null for outputs that are no files. A checkpoint that is there without
// --resume is not overwritten: it may be days of work.
std::unique_ptr<Checkpoint> openCheckpoint(const FitArguments& a, const TablePlan& plan) {
  if (isStream(a.output)) {
    if (a.resume) throw InputError("--resume: " + a.output + " is not a file");
    return nullptr;
  }
  std::error_code ignored;
  const std::string path = a.output + ".part";
  if (!a.resume && std::filesystem::exists(path, ignored)) {
    throw InputError(path +
                     ": of a run that was interrupted or is still going; --resume goes on with it, without "
                     "that file a run "
                     "starts anew");
  }
#ifdef __FMA__
  constexpr const char* kBuild = " native";
#else
  constexpr const char* kBuild = "";
#endif
  const std::string fingerprint = makeProvenance(a).command + ", ltcfit " LTCFIT_VERSION + kBuild;
  try {
    return std::make_unique<Checkpoint>(path, fingerprint, plan.jobs.size());
  } catch (const Refusal& error) {
    throw InputError(error.what());
  }
}

}  // namespace

int refuseUnusable(std::size_t unusable, const FitArguments& a) {
  if (unusable == 0) return kExitOk;
  complain(fmt::format(
      "{} entries are unusable (no inverse in float32, or worse than no light): no table was written{}",
      unusable,
      !a.reportPath.empty() ? ""
      : isWarmStartedL3(a) || isStream(a.output)
          ? "; --report FILE.csv lists them"
          : fmt::format("; --resume --report FILE.csv lists them at once, without {}.part a run starts anew",
                        a.output)));
  return kExitQuality;
}

int fitTableCommand(const FitArguments& a, const TablePlan& plan) {
  const TableFitOptions options = toFitOptions(a);
  const SymmetryMode symmetry = symmetryOf(a);
  try {
    // the axes, before the work and not after it
    const Table axes(plan.info, std::vector<float>(plan.nodes.size() * plan.info.channels.size(), 0.0f));
  } catch (const Refusal& error) {
    throw InputError(std::string("--axes, --theta-max or --alpha-floor: ") + error.what());
  }
  const std::unique_ptr<Checkpoint> checkpoint = openCheckpoint(a, plan);
  checkRefinement(a);
  const std::size_t resumed = checkpoint ? checkpoint->size() : 0;
  const Stopwatch watch;
  TableFitResult result;
  {
    Progress progress("fit", a.quiet);
    result = fitTable(plan, symmetry, options, checkpoint.get(),
                      [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  }
  const Times times = watch.elapsed();
  TableInfo info = plan.info;
  info.provenance = makeProvenance(a);
  if (!a.reportPath.empty()) writeFileAtomically(a.reportPath, reportCsv(plan, result));
  std::optional<FitOutput> output;
  if (result.unusable == 0) output = writeFit(Table(info, result.data), a);
  // what made an unusable table stays, for --resume --report
  if (checkpoint && output && output->written) checkpoint->remove();
  const std::unique_ptr<Score> score = output ? scoreFit(output->table, a) : nullptr;
  if (a.json) {
    nlohmann::ordered_json out = toJson(a, plan, result, times, resumed);
    if (output) addFitOutput(*output, &out);
    addLookup(summarizeLookup(info), &out);
    if (score) addScore(*score, &out);
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else if (!a.quiet) {
    printText(a, plan, result, times, resumed);
    if (output) printFitOutput(*output, a);
    printLookup(summarizeLookup(info));
    if (score) printScore(*score, a);
  }
  return output ? exitCodeOf(*output) : refuseUnusable(result.unusable, a);
}

}  // namespace ltcfit::app
