#include "report/stability_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ltcfit {
namespace {

// Lobes this sharp do not reach where the cosine, the identity, puts its samples.
constexpr double kSharpAlpha = 0.01;

// Against the fitter's own result from the usual start: objectives differ in what they want.
bool reached(const StabilityRun& run, const StabilityRow& row) {
  return run.sw1 <= kOtherMinimum * row.sw1;
}

// Rows of a fitter in which some run from `start` did not come to where the usual start leads.
StabilityFinding notReached(const std::vector<StabilityRow>& rows, Fitter fitter, Start start,
                            double largestAlpha, std::string title) {
  StabilityFinding out;
  out.title = std::move(title);
  std::size_t flat = 0;
  for (const StabilityRow& row : rows) {
    // at normal view no lobe of the family misses the target
    if (row.fitter != fitter || row.parameters.alphaX > largestAlpha ||
        (start == Start::kNoOverlap && row.parameters.theta == 0.0))
      continue;
    ++out.of;
    const auto failed = std::find_if(row.runs.begin(), row.runs.end(), [&](const StabilityRun& run) {
      return run.start == start && !reached(run, row);
    });
    if (failed == row.runs.end()) continue;
    ++out.rows;
    flat += failed->outcome == Outcome::kFlat ? 1 : 0;
  }
  out.text = "not reached";
  if (flat > 0) out.text += fmt::format("; for {} nothing at the start says where the lobe is", flat);
  return out;
}

// Of fits that descend from the usual start too: what the given start is worth alone.
StabilityFinding ownDescents(const std::vector<StabilityRow>& rows, Fitter fitter) {
  StabilityFinding out;
  out.title =
      fmt::format("{}: descents from other starts than the usual one, on their own", fitterName(fitter));
  std::array<std::size_t, kStartCount> lobes{};
  for (const StabilityRow& row : rows) {
    if (row.fitter != fitter) continue;
    ++out.of;
    std::array<bool, kStartCount> lost{};
    for (const StabilityRun& run : row.runs)
      if (run.restarted) lost[static_cast<std::size_t>(run.start)] = true;
    for (std::size_t s = 0; s < kStartCount; ++s) lobes[s] += lost[s] ? 1 : 0;
    out.rows += std::find(lost.begin(), lost.end(), true) != lost.end() ? 1 : 0;
  }
  out.text = "one does not arrive, and the usual start's is kept:";
  for (const Start start : {Start::kIdentity, Start::kNeighbour, Start::kNoOverlap})
    out.text += fmt::format("{} {} {}", start == Start::kIdentity ? "" : ",", startName(start),
                            lobes[static_cast<std::size_t>(start)]);
  return out;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<StabilityFinding> stabilityFindings(const std::vector<StabilityRow>& rows) {
  std::vector<StabilityFinding> out;
  const auto ran = [&](Fitter fitter) {
    return std::any_of(rows.begin(), rows.end(),
                       [&](const StabilityRow& row) { return row.fitter == fitter; });
  };
  if (ran(Fitter::kL3)) {
    out.push_back(notReached(rows, Fitter::kL3, Start::kNoOverlap, 1.0,
                             "Nelder-Mead on L3 from a start that does not overlap the lobe"));
    out.push_back(notReached(
        rows, Fitter::kL3, Start::kIdentity, kSharpAlpha,
        fmt::format("Nelder-Mead on L3 from the identity, sharp lobes (alpha <= {})", kSharpAlpha)));
  }
  if (ran(Fitter::kSlicedWassersteinSgd)) {
    out.push_back(notReached(rows, Fitter::kSlicedWassersteinSgd, Start::kNoOverlap, 1.0,
                             "sw-sgd from a start that does not overlap the lobe"));
  }
  for (const Fitter fitter : {Fitter::kSlicedWasserstein, Fitter::kLight})
    if (ran(fitter)) out.push_back(ownDescents(rows, fitter));
  for (const Fitter fitter : {Fitter::kLight, Fitter::kSlicedWasserstein}) {
    std::vector<double> raw, scaled;
    StabilityFinding worse{.title = fmt::format("{}: the Hessian in raw entries of M", fitterName(fitter)),
                           .text = {}};
    for (const StabilityRow& row : rows) {
      if (row.fitter != fitter || row.parameters.alphaX > kSharpAlpha) continue;
      if (!std::isfinite(row.probe.conditionRaw) || !std::isfinite(row.probe.conditionScaled)) continue;
      raw.push_back(row.probe.conditionRaw);
      scaled.push_back(row.probe.conditionScaled);
      ++worse.of;
      worse.rows += row.probe.conditionRaw > 10.0 * row.probe.conditionScaled ? 1 : 0;
    }
    if (worse.of == 0) continue;
    worse.text = fmt::format(
        "condition ten times that in the scaled parameters or more, of sharp lobes (alpha <= {}); medians "
        "{:.1e} and {:.1e}",
        kSharpAlpha, median(raw), median(scaled));
    out.push_back(worse);
  }
  return out;
}

}  // namespace ltcfit
