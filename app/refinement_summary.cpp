#include "app/refinement_summary.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

namespace ltcfit::app {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::array<const char*, 3> kOf{"direct_fits", "before", "after"};
constexpr std::array<const char*, 3> kOfText{"direct fits", "before", "after"};

OrderedJson figuresJson(const FreshErrors& e, bool direct) {
  OrderedJson json{{"sw", e.mean.sw}, {"sw_rel", e.swRel}, {"form", e.mean.form}, {"light", e.mean.light}};
  if (!direct) {
    json["below"] = e.below;
    json["unusable"] = e.unusable;
  }
  return json;
}

OrderedJson figuresJson(const Summary& s) {
  return {{"mean", s.mean}, {"p99", s.p99}, {"max", s.max}, {"non_finite", s.nonFinite}};
}

}  // namespace

RefinementFigures measureRefinement(const RefinementRun& run, std::size_t count,
                                    const RefinementOptions& options) {
  if (count == 0 || run.result.unusable > 0) return {};
  const Table& after = run.result.table;
  return {
      count,
      errorsAtFreshPoints({&run.before, &after}, LookUpLossOptions{}, count, options.seed, options.threads),
      tableSmoothness(run.before, options.threads), tableSmoothness(after, options.threads)};
}

void printRefinement(const RefinementRun& run, const RefinementFigures& figures) {
  const RefinementResult& r = run.result;
  fmt::print("refined: {} iterations{}, cost {:.5f} to {:.5f}: {:.1f} CPU s, {:.1f} s wall\n",
             r.state.iterations,
             run.resumedAt ? fmt::format(" ({} of them by the interrupted run)", *run.resumedAt) : "",
             r.startCost, r.state.cost, run.times.cpu, run.times.wall);
  if (figures.count == 0) return;
  fmt::print("mean errors at {} look-ups that the refinement has not seen:\n", figures.count);
  fmt::print("  {:<12}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "sw", "sw/spread", "form", "light",
             "below", "unusable");
  for (std::size_t i = 0; i < figures.errors.size(); ++i) {
    const FreshErrors& e = figures.errors[i];
    fmt::print("  {:<12}{:>10.5f}{:>10.5f}{:>10.5f}{:>10.5f}", kOfText[i], e.mean.sw, e.swRel, e.mean.form,
               e.mean.light);
    fmt::print("{}\n", i == 0 ? std::string() : fmt::format("{:>10.5f}{:>10}", e.below, e.unusable));
  }
  fmt::print("largest jump between neighbours beyond the lobe's own step, in lobe widths:\n");
  for (std::size_t a = 0; a < figures.before.size(); ++a) {
    const Summary& b = figures.before[a].summary;
    const Summary& e = figures.after[a].summary;
    fmt::print("  {:<12}{:.3f} to {:.3f} (mean {:.4f} to {:.4f})\n", figures.before[a].axis, b.max, e.max,
               b.mean, e.mean);
  }
}

void addRefinement(const RefinementRun& run, const RefinementFigures& figures, OrderedJson* out) {
  const RefinementResult& r = run.result;
  OrderedJson& json = (*out)["refinement"];
  json = {{"iterations", r.state.iterations},
          {"resumed_at", run.resumedAt ? OrderedJson(*run.resumedAt) : OrderedJson(nullptr)},
          {"termination", terminationName(r.termination)},
          {"cost", {{"start", r.startCost}, {"end", r.state.cost}}},
          {"cpu_seconds", run.times.cpu},
          {"wall_seconds", run.times.wall},
          {"unusable", r.unusable}};
  if (figures.count == 0) return;
  json["fresh"]["count"] = figures.count;
  for (std::size_t i = 0; i < figures.errors.size(); ++i)
    json["fresh"][kOf[i]] = figuresJson(figures.errors[i], i == 0);
  for (std::size_t a = 0; a < figures.before.size(); ++a)
    json["smoothness"][figures.before[a].axis] = {{"before", figuresJson(figures.before[a].summary)},
                                                  {"after", figuresJson(figures.after[a].summary)}};
}

}  // namespace ltcfit::app
