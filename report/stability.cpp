#include "report/stability.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "base/parallel_for.h"
#include "fit/l3_objective.h"
#include "fit/moment_start.h"
#include "fit/target_lobe.h"
#include "report/compare.h"
#include "report/metrics.h"
#include "report/stability_findings.h"
#include "report/storage_shift.h"
#include "report/table_at_lobes.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;

constexpr const char* kStabilityBrdf = "ggx";
// Samples that no fit sees, for SW1: the same for all runs on a lobe.
constexpr int kUnseenLobe = 16384;
constexpr int kUnseenCosine = 8192;
constexpr int kUnseenSlices = 101;  // others than those of any preset
const double kTableFloor = AnisotropicTableOptions{}.alphaFloor;
constexpr int kTvSamples = 4096;
// The start "neighbour".
constexpr double kNeighbourAlpha = 1.5;
constexpr double kNeighbourTheta = 5.0 / 180.0 * std::numbers::pi;
constexpr double kFlatStep = 1e-2;

constexpr std::array<Start, kStartCount> kStarts{Start::kMoments, Start::kIdentity, Start::kNeighbour,
                                                 Start::kNoOverlap};

TableKind kindOf(const LobeParameters& p) {
  return p.alphaX == p.alphaY ? TableKind::kIsotropic : TableKind::kAnisotropic;
}

LobeParameters neighbourOf(LobeParameters p) {
  p.alphaX = std::min(1.0, kNeighbourAlpha * p.alphaX);
  p.alphaY = std::min(1.0, kNeighbourAlpha * p.alphaY);
  p.theta += p.theta > kNeighbourTheta ? -kNeighbourTheta : kNeighbourTheta;
  return p;
}

// Everything about a lobe that judges fits of it.
struct Judge {
  Judge(const LobeParameters& p, MatrixFamily family)
      : lobe(makeTargetLobe(kStabilityBrdf, p)),
        metrics(*lobe, MetricOptions{.samples = kTvSamples, .directions = 1, .quads = 1, .lights = 1}),
        samples(weightedSamples(*lobe, kUnseenLobe, mixSeed(1, 70))),
        moments(projectOnFamily(momentStart(samples), family)),
        sw1(samples, moments, cosineSamples(kUnseenCosine, mixSeed(1, 71)),
            familySlices(family, kUnseenSlices)) {}
  Judge(const Judge&) = delete;
  Judge& operator=(const Judge&) = delete;

  double tv(const Matrix3d& m) const { return metrics.evaluate(Ltc(m)).get(Metric::kTv); }
  double overBest(double value, double best) const {
    return errorOver(value, best, metrics.moments().spread);
  }

  std::unique_ptr<Lobe> lobe;
  MetricTarget metrics;
  LobeSamples samples;
  Matrix3d moments;
  ProjectedCdfLoss sw1;
};

// Whether the L3 cost about a start says where the lobe is: the steps of P that move the lobe change it.
bool isFlat(const LobeFitTarget& target, const Matrix3d& start, const LobeFitOptions& options) {
  const L3Objective cost(target.lobe(), target.moments().albedo, options.l3.samples, options.l3.seed);
  const double at = cost(start);
  for (const Matrix3d& b : familyBasis(target.family())) {
    if (b.col(2).head<2>().norm() < 0.5) continue;
    const double above = cost(start * (Matrix3d::Identity() + kFlatStep * b));
    const double below = cost(start * (Matrix3d::Identity() - kFlatStep * b));
    if (std::abs(above - below) / (2.0 * kFlatStep * at) > kFlatGradient) return false;
  }
  return true;
}

// One fit with what is needed to say how it ended.
struct Attempt {
  StabilityRun run;
  Termination termination;
  Matrix3d m;
  bool flatStart;
};

Attempt attempt(LobeFitTarget& target, Judge& judge, Start start, const Matrix3d& from,
                const LobeFitOptions& options) {
  const LobeFit fit = fitLobe(target, from, options);
  Attempt a;
  a.run.start = start;
  a.run.seed = options.sw.seed;
  a.termination = fit.termination;
  a.m = fit.m;
  a.flatStart = options.fitter == Fitter::kL3 && isFlat(target, from, options);
  a.run.restarted = fit.restarted;
  a.run.handedOver = fit.handedOver;
  a.run.startKept = fit.startKept;
  if (!fit.m.allFinite() || fit.m.determinant() == 0.0 || !fit.m.inverse().allFinite()) {
    a.run.sw1 = std::numeric_limits<double>::quiet_NaN();
    a.run.outcome = Outcome::kNonFinite;
    return a;
  }
  a.run.detNegative = fit.m.determinant() < 0.0;
  if (a.run.detNegative) a.m.col(1) *= -1.0;
  a.m = normalized(a.m, MatrixNormalization::kThirdColumnUnit);
  a.run.sw1 = judge.sw1(a.m, nullptr);
  return a;
}

Outcome outcomeOf(const Attempt& a, const Judge& judge, double best) {
  if (a.run.outcome == Outcome::kNonFinite) return a.run.outcome;
  if (judge.overBest(a.run.sw1, best) > kOtherMinimum) {
    const bool apart = judge.tv(a.m) > kNoOverlapTv;
    if (a.flatStart && apart) return Outcome::kFlat;
    if (apart) return Outcome::kNoOverlap;
    if (a.termination == Termination::kConverged) return Outcome::kOtherMinimum;
  }
  switch (a.termination) {
    case Termination::kFailure:
      return Outcome::kFailure;
    case Termination::kMaxEvaluations:
      return Outcome::kMaxEvaluations;
    case Termination::kConverged:
      break;
  }
  return Outcome::kConverged;
}

// Over the runs that `take` picks.
template <class Take>
double spreadOf(const std::vector<StabilityRun>& runs, const Take& take) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const StabilityRun& run : runs) {
    if (!take(run)) continue;
    if (!std::isfinite(run.sw1)) return std::numeric_limits<double>::infinity();
    low = std::min(low, run.sw1);
    high = std::max(high, run.sw1);
  }
  return high > 0.0 ? high / low - 1.0 : 0.0;
}

// All fitters on one lobe; `best` over all of them.
std::vector<StabilityRow> runLobe(const LobeParameters& p, std::size_t index, const Table* table,
                                  const StabilityOptions& options) {
  const LobeJob job{p, familyOf(p)};
  const LobeParameters next = neighbourOf(p);
  Judge judge(p, job.family);
  std::vector<StabilityRow> rows;
  std::vector<std::vector<Attempt>> attempts;
  double best = std::numeric_limits<double>::infinity();
  for (const Fitter fitter : options.fitters) {
    const bool isDefault = fitter == kDefaultFitter;
    if (fitter == Fitter::kSlicedWassersteinSgd && !options.full &&
        index % static_cast<std::size_t>(options.sgdEvery) != 0)
      continue;
    LobeFitOptions fit = tableFitPreset(kindOf(p), fitter);
    StabilityRow row;
    row.parameters = p;
    row.fitter = fitter;
    row.isDefault = isDefault;
    std::vector<Attempt> tried;
    const int seeds = isDefault || options.full ? options.seeds : 1;
    for (int seed = 1; seed <= seeds; ++seed) {
      fit.setSeed(static_cast<std::uint64_t>(seed));
      LobeFitTarget target(job, kStabilityBrdf, fit);
      LobeFitTarget nextTarget({next, familyOf(next)}, kStabilityBrdf, fit);
      const Matrix3d neighbour = fitLobe(nextTarget, nextTarget.momentStart(), fit).m;
      for (const Start start : kStarts) {
        const Matrix3d from = startMatrix(start, job, target.momentStart(), neighbour);
        tried.push_back(attempt(target, judge, start, from, fit));
        if (std::isfinite(tried.back().run.sw1)) best = std::min(best, tried.back().run.sw1);
      }
    }
    const Attempt& usual = tried.front();
    row.sw1 = usual.run.sw1;
    if (std::isfinite(row.sw1)) {
      fit.setSeed(1);
      const LobeFitTarget target(job, kStabilityBrdf, fit);
      const Matrix3d m = usual.m;
      row.conditionM = conditionOf(m);
      row.tv = judge.tv(m);
      row.probe = probeObjective(target, m, fit);
      const double spread = judge.metrics.moments().spread;
      row.float32Shift = float32Shift(m) / spread;
      row.halfShift = halfShift(m, kindOf(p));
      if (isDefault && table != nullptr && p.alphaY >= kTableFloor) {
        const TableEntry entry = table->fetch(p);
        if (entry.invertible) row.interpolation = lobeDistance(entry.m, m) / spread;
      }
    } else {
      row.tv = row.conditionM = row.float32Shift = row.halfShift = row.probe.conditionScaled =
          row.probe.conditionRaw = std::numeric_limits<double>::quiet_NaN();
    }
    rows.push_back(std::move(row));
    attempts.push_back(std::move(tried));
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    StabilityRow& row = rows[r];
    for (Attempt& a : attempts[r]) {
      a.run.outcome = outcomeOf(a, judge, best);
      ++row.outcomes[static_cast<std::size_t>(a.run.outcome)];
      row.nonFinite += a.run.outcome == Outcome::kNonFinite ? 1 : 0;
      row.sw1OverBest = std::isfinite(a.run.sw1) ? std::max(row.sw1OverBest, judge.overBest(a.run.sw1, best))
                                                 : std::numeric_limits<double>::infinity();
      row.runs.push_back(a.run);
    }
    row.spreadStarts = spreadOverStarts(row.runs);
    row.spreadSeeds = spreadOverSeeds(row.runs);
    if (row.isDefault) row.broken = brokenLimits(row);
  }
  return rows;
}

}  // namespace

std::string_view outcomeName(Outcome outcome) {
  static constexpr std::array<std::string_view, kOutcomeCount> kNames{
      "converged", "max-evaluations", "flat", "no-overlap", "other-minimum", "non-finite", "failure"};
  return kNames[static_cast<std::size_t>(outcome)];
}

const std::vector<StabilityLimit>& stabilityLimits() {
  static const std::vector<StabilityLimit> limits{
      {"non_finite", 0.0, "matrices that are not finite or have no inverse"},
      {"det_negative", 0.0, "matrices of negative determinant"},
      {"not_converged", 0.0, "runs that did not converge on the lobe"},
      {"spread_starts", 0.01, "spread of SW1 over the starts, where LTCs can represent the lobe (TV <= 0.2)"},
      {"sw1_over_best", kOtherMinimum,
       "SW1 of the worst run over the best that any fitter found, both at least a hundredth of the lobe's "
       "width"},
      {"gradient_error", 1e-4, "relative error of the derivatives against differences"},
      {"float32_shift", 0.01,
       "shift of the lobe by float32 storage and inversion, in widths of the lobe: a hundredth is no error"},
      {"half_shift", 0.05,
       "shift of the lobe by half storage, radians, above which export warns; alpha_y from 0.001008 on"},
  };
  return limits;
}

double errorOver(double value, double best, double width) {
  const double least = kSmallestError * width;
  return std::max(value, least) / std::max(best, least);
}

double spreadOverStarts(const std::vector<StabilityRun>& runs) {
  double largest = 0.0;
  for (const StabilityRun& one : runs) {
    largest = std::max(largest, spreadOf(runs, [&](const StabilityRun& r) { return r.seed == one.seed; }));
  }
  return largest;
}

double spreadOverSeeds(const std::vector<StabilityRun>& runs) {
  return spreadOf(runs, [](const StabilityRun& r) { return r.start == Start::kMoments; });
}

double limitedFigure(const StabilityRow& row, std::string_view id) {
  if (id == "non_finite") return row.nonFinite;
  if (id == "det_negative") {
    return static_cast<double>(
        std::count_if(row.runs.begin(), row.runs.end(), [](const StabilityRun& r) { return r.detNegative; }));
  }
  if (id == "not_converged") {
    int count = 0;
    for (std::size_t o = 0; o < kOutcomeCount; ++o)
      count += static_cast<Outcome>(o) == Outcome::kConverged ? 0 : row.outcomes[o];
    return count;
  }
  if (id == "spread_starts") return row.tv <= kRepresentableTv ? row.spreadStarts : 0.0;
  if (id == "sw1_over_best") return row.sw1OverBest;
  if (id == "gradient_error") return row.probe.gradientError.value_or(0.0);
  if (id == "float32_shift") return row.float32Shift;
  return row.parameters.alphaY >= kHalfAlpha ? row.halfShift : 0.0;
}

std::vector<std::string_view> brokenLimits(const StabilityRow& row) {
  std::vector<std::string_view> out;
  for (const StabilityLimit& limit : stabilityLimits())
    if (!(limitedFigure(row, limit.id) <= limit.limit)) out.push_back(limit.id);
  return out;
}

StabilityResult runStability(const StabilityOptions& options,
                             const std::function<void(std::size_t, std::size_t)>& progress) {
  const std::size_t n = options.lobes.size();
  const TablesAtLobes tables = fitTablesAt(options.lobes, options.threads);
  std::vector<std::vector<StabilityRow>> rows(n);
  std::size_t done = 0;
  parallelFor(n, {.threads = options.threads}, [&](std::size_t i) {
    const LobeParameters& p = options.lobes[i];
    const std::optional<Table>& table =
        kindOf(p) == TableKind::kIsotropic ? tables.isotropic : tables.anisotropic;
    rows[i] = runLobe(p, i, table ? &*table : nullptr, options);
    return [&] {
      if (progress) progress(++done, n);
    };
  });
  StabilityResult result;
  for (std::vector<StabilityRow>& lobe : rows)
    for (StabilityRow& row : lobe) result.rows.push_back(std::move(row));
  result.failed = static_cast<std::size_t>(std::count_if(
      result.rows.begin(), result.rows.end(), [](const StabilityRow& r) { return !r.broken.empty(); }));
  result.findings = stabilityFindings(result.rows);
  return result;
}

}  // namespace ltcfit
