#include "fit/isotropic_table_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/parallel_for.h"
#include "fit/lobe_shape.h"
#include "ggx/ggx_lobe.h"
#include "ltc/ltc.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;

// First simplex of a second try against that of the first: it should leave the valley that the first one
// chose.
constexpr double kRefitEdgeFactor = 4.0;

// det > 0 follows from the parametrisation; it is checked all the same, on the way into the table.
bool isUsable(const Matrix3d& m) {
  return m.determinant() > 0.0 && isInvertibleInFloat(m);
}

// The work on one table: nodes by (theta index t, alpha index a).
class TableFit {
 public:
  TableFit(const IsotropicFitOptions& options, const FitProgress& progress)
      : options_(options),
        progress_(progress),
        info_(planIsotropicTable(options.table).info),
        nT_(options.table.thetaNodes),
        nA_(options.table.alphaNodes),
        moments_(nT_ * nA_),
        shapes_(nT_ * nA_),
        reports_(nT_ * nA_) {}

  IsotropicFitResult run() {
    // At normal view, from alpha = 1 down: each entry starts from the one before, the first from the
    // identity, which is nearly its solution.
    for (std::size_t a = nA_; a-- > 0;) {
      const bool first = a + 1 == nA_;
      fitFirst(0, a, first ? Start{0, a, WarmStart::kIdentity} : Start{0, a + 1, WarmStart::kAlphaNeighbour});
    }
    // sharp rows take longest: first, so that no thread ends alone with one
    parallelFor(nA_, {.threads = options_.threads}, [&](std::size_t a) {
      for (std::size_t t = 1; t < nT_; ++t) fitFirst(t, a, {t - 1, a, WarmStart::kThetaNeighbour});
    });
    refitOutliers();
    return finish();
  }

 private:
  struct Start {
    std::size_t t, a;
    WarmStart kind;
  };

  std::size_t flat(std::size_t t, std::size_t a) const { return t * nA_ + a; }
  double theta(std::size_t t) const { return info_.axes[0].values[t]; }
  double alpha(std::size_t a) const { return info_.axes[1].values[a]; }
  GgxLobe lobe(std::size_t t, std::size_t a) const {
    return GgxLobe(viewDirection(theta(t), 0.0), {alpha(a), alpha(a)});
  }

  // The neighbour's matrix, carried into this entry's frame of the mean direction and scaled by the ratios of
  // the lobes' widths: a sharp lobe turns by many of its own widths from one angle node to the next, and near
  // grazing view it narrows by orders of magnitude.
  Matrix3d startMatrix(std::size_t t, std::size_t a, const Start& from) const {
    if (from.kind == WarmStart::kIdentity) return Matrix3d::Identity();
    const std::size_t target = flat(t, a);
    if (from.kind == WarmStart::kShape) return matrixOfShape(shapes_[target], moments_[target].mean);
    const std::size_t source = flat(from.t, from.a);
    Matrix3d local = frameAbout(moments_[source].mean).transpose() * reports_[source].fit.m;
    local.col(0) *= shapes_[target].inPlane / shapes_[source].inPlane;
    local.col(1) *= shapes_[target].across / shapes_[source].across;
    return frameAbout(moments_[target].mean) * local;
  }

  void fitFirst(std::size_t t, std::size_t a, const Start& from) {
    const std::size_t i = flat(t, a);
    const GgxLobe target = lobe(t, a);
    moments_[i] = computeMoments(target);
    shapes_[i] = measureLobeShape(target, moments_[i].mean);
    EntryReport& report = reports_[i];
    report.fit = fitIsotropicEntry(target, moments_[i], startMatrix(t, a, from), options_.entry);
    report.warmStart = from.kind;
    report.totalEvaluations = report.fit.evaluations;
    if (progress_) {
      const std::lock_guard lock(progressMutex_);
      progress_(++done_, reports_.size());
    }
  }

  std::vector<Start> neighbours(std::size_t t, std::size_t a) const {
    std::vector<Start> out;
    if (t > 0) out.push_back({t - 1, a, WarmStart::kThetaNeighbour});
    if (t + 1 < nT_) out.push_back({t + 1, a, WarmStart::kThetaNeighbour});
    if (a > 0) out.push_back({t, a - 1, WarmStart::kAlphaNeighbour});
    if (a + 1 < nA_) out.push_back({t, a + 1, WarmStart::kAlphaNeighbour});
    return out;
  }

  bool suspicious(std::size_t t, std::size_t a) const {
    const EntryFit& fit = reports_[flat(t, a)].fit;
    if (fit.termination != Termination::kConverged || !isUsable(fit.m)) return true;
    if (fit.relativeL3 < kGoodEnough) return false;
    std::vector<double> errors;
    for (const Start& n : neighbours(t, a)) errors.push_back(reports_[flat(n.t, n.a)].fit.relativeL3);
    std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                     errors.end());
    return !(fit.relativeL3 <= kNeighbourFactor * errors[errors.size() / 2]);
  }

  // All second tries read the first results only, so that their order does not matter.
  void refitOutliers() {
    std::vector<std::size_t> suspects;
    for (std::size_t i = 0; i < reports_.size(); ++i) {
      if (suspicious(i / nA_, i % nA_)) suspects.push_back(i);
    }
    std::vector<EntryReport> better(suspects.size());
    parallelFor(suspects.size(), {.threads = options_.threads}, [&](std::size_t k) {
      const std::size_t i = suspects[k];
      const std::size_t t = i / nA_;
      const std::size_t a = i % nA_;
      EntryReport best = reports_[i];
      best.refitted = true;
      std::vector<Start> starts = neighbours(t, a);
      starts.push_back({t, a, WarmStart::kShape});
      EntryFitOptions wider = options_.entry;
      wider.simplexEdge *= kRefitEdgeFactor;
      for (const Start& from : starts) {
        const EntryFit again = fitIsotropicEntry(lobe(t, a), moments_[i], startMatrix(t, a, from), wider);
        best.totalEvaluations += again.evaluations;
        if (!isUsable(again.m)) continue;
        if (again.cost < best.fit.cost || !isUsable(best.fit.m)) {
          best.fit = again;
          best.warmStart = from.kind;
          best.improved = true;
        }
      }
      better[k] = best;
    });
    for (std::size_t k = 0; k < suspects.size(); ++k) reports_[suspects[k]] = better[k];
  }

  IsotropicFitResult finish() {
    IsotropicFitResult result;
    result.info = info_;
    result.data.reserve(reports_.size() * info_.channels.size());
    for (std::size_t i = 0; i < reports_.size(); ++i) {
      EntryReport& report = reports_[i];
      const Matrix3d m = normalized(report.fit.m, info_.normalization);
      report.usable = isUsable(m) && report.fit.relativeL3 < 1.0;
      for (double x :
           {m(0, 0), m(0, 2), m(1, 1), m(2, 0), m(2, 2), moments_[i].albedo, moments_[i].fresnel}) {
        result.data.push_back(static_cast<float>(x));
      }
      result.evaluations += report.totalEvaluations;
      result.refitted += report.refitted ? 1 : 0;
      result.improvedByRefit += report.improved ? 1 : 0;
      result.notConverged += report.fit.termination != Termination::kConverged ? 1 : 0;
      result.unusable += report.usable ? 0 : 1;
      result.largestMomentError = std::max(result.largestMomentError, moments_[i].error);
    }
    result.reports = std::move(reports_);
    return result;
  }

  const IsotropicFitOptions& options_;
  const FitProgress& progress_;
  TableInfo info_;
  std::size_t nT_;
  std::size_t nA_;
  std::vector<LobeMoments> moments_;
  std::vector<LobeShape> shapes_;
  std::vector<EntryReport> reports_;
  std::mutex progressMutex_;
  std::size_t done_ = 0;
};

}  // namespace

std::string_view warmStartName(WarmStart start) {
  switch (start) {
    case WarmStart::kIdentity:
      return "identity";
    case WarmStart::kAlphaNeighbour:
      return "alpha-neighbour";
    case WarmStart::kThetaNeighbour:
      return "theta-neighbour";
    case WarmStart::kShape:
      break;
  }
  return "shape";
}

bool IsotropicFitOptions::isValid(std::string* error) const {
  if (!table.isValid(error)) return false;
  if (entry.samples < 16 || entry.samples > 1 << 22) {
    *error = "--samples " + std::to_string(entry.samples) + " must be in [16, 4194304]";
    return false;
  }
  if (threads < 0) {
    *error = "--threads " + std::to_string(threads) + " must not be negative";
    return false;
  }
  return entry.nelderMead.isValid(error);
}

IsotropicFitResult fitIsotropicTable(const IsotropicFitOptions& options, const FitProgress& progress) {
  return TableFit(options, progress).run();
}

}  // namespace ltcfit
