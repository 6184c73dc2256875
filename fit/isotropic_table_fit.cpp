#include "fit/isotropic_table_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <utility>

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

// A lobe as its neighbours see it, and its matrix, if it has one already.
struct FittedLobe {
  Eigen::Vector3d mean;
  LobeShape shape;
  Matrix3d m = Matrix3d::Identity();
};

// The neighbour's matrix, carried into this entry's frame of the mean direction and scaled by the ratios of
// the lobes' widths: a sharp lobe turns by many of its own widths from one angle node to the next, and near
// grazing view it narrows by orders of magnitude.
Matrix3d carried(const FittedLobe& from, const FittedLobe& to) {
  Matrix3d local = frameAbout(from.mean).transpose() * from.m;
  local.col(0) *= to.shape.inPlane / from.shape.inPlane;
  local.col(1) *= to.shape.across / from.shape.across;
  return frameAbout(to.mean) * local;
}

// Whether a fit is to be tried again, by the relative L3 errors of its neighbours.
bool isSuspicious(const EntryFit& fit, std::vector<double> errors) {
  if (fit.termination != Termination::kConverged || !isUsable(fit.m)) return true;
  if (fit.relativeL3 < kGoodEnough) return false;
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  return !(fit.relativeL3 <= kNeighbourFactor * errors[errors.size() / 2]);
}

EntryFitOptions ofSecondTry(EntryFitOptions entry) {
  entry.simplexEdge *= kRefitEdgeFactor;
  return entry;
}

bool isBetter(const EntryFit& again, const EntryFit& best) {
  return isUsable(again.m) && (again.cost < best.cost || !isUsable(best.m));
}

// The work on one table: nodes by (theta index t, alpha index a).
class TableFit {
 public:
  TableFit(TableInfo info, const EntryFitOptions& entry, int threads, const FitProgress& progress)
      : entry_(entry),
        threads_(threads),
        progress_(progress),
        info_(std::move(info)),
        nT_(info_.axes[0].size()),
        nA_(info_.axes[1].size()),
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
    parallelFor(nA_, {.threads = threads_}, [&](std::size_t a) {
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

  FittedLobe fitted(std::size_t i) const { return {moments_[i].mean, shapes_[i], reports_[i].fit.m}; }

  Matrix3d startMatrix(std::size_t t, std::size_t a, const Start& from) const {
    if (from.kind == WarmStart::kIdentity) return Matrix3d::Identity();
    const std::size_t target = flat(t, a);
    if (from.kind == WarmStart::kShape) return matrixOfShape(shapes_[target], moments_[target].mean);
    return carried(fitted(flat(from.t, from.a)), fitted(target));
  }

  void fitFirst(std::size_t t, std::size_t a, const Start& from) {
    const std::size_t i = flat(t, a);
    const GgxLobe target = lobe(t, a);
    moments_[i] = computeMoments(target);
    shapes_[i] = measureLobeShape(target, moments_[i].mean);
    EntryReport& report = reports_[i];
    report.fit = fitIsotropicEntry(target, moments_[i], startMatrix(t, a, from), entry_);
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
    std::vector<double> errors;
    for (const Start& n : neighbours(t, a)) errors.push_back(reports_[flat(n.t, n.a)].fit.relativeL3);
    return isSuspicious(reports_[flat(t, a)].fit, std::move(errors));
  }

  // All second tries read the first results only, so that their order does not matter.
  void refitOutliers() {
    std::vector<std::size_t> suspects;
    for (std::size_t i = 0; i < reports_.size(); ++i) {
      if (suspicious(i / nA_, i % nA_)) suspects.push_back(i);
    }
    std::vector<EntryReport> better(suspects.size());
    parallelFor(suspects.size(), {.threads = threads_}, [&](std::size_t k) {
      const std::size_t i = suspects[k];
      const std::size_t t = i / nA_;
      const std::size_t a = i % nA_;
      EntryReport best = reports_[i];
      best.refitted = true;
      std::vector<Start> starts = neighbours(t, a);
      starts.push_back({t, a, WarmStart::kShape});
      const EntryFitOptions wider = ofSecondTry(entry_);
      for (const Start& from : starts) {
        const EntryFit again = fitIsotropicEntry(lobe(t, a), moments_[i], startMatrix(t, a, from), wider);
        best.totalEvaluations += again.evaluations;
        if (isBetter(again, best.fit)) {
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

  const EntryFitOptions& entry_;
  int threads_;
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
  if (threads < 0) {
    *error = "--threads " + std::to_string(threads) + " must not be negative";
    return false;
  }
  return entry.isValid(error);
}

IsotropicFitResult fitIsotropicTable(const IsotropicFitOptions& options, const FitProgress& progress) {
  return TableFit(planIsotropicTable(options.table).info, options.entry, options.threads, progress).run();
}

IsotropicFitResult fitIsotropicTable(std::vector<Axis> axes, double alphaFloor, const EntryFitOptions& entry,
                                     int threads, const FitProgress& progress) {
  return TableFit(planIsotropicTable(std::move(axes), alphaFloor).info, entry, threads, progress).run();
}

EntryFit fitBetweenNodes(const IsotropicFitResult& table, double theta, double alpha,
                         const EntryFitOptions& entry) {
  const std::vector<double>& thetas = table.info.axes[0].values;
  const std::vector<double>& alphas = table.info.axes[1].values;
  // the last node not after the point, or the first; and the one after that
  const auto about = [](const std::vector<double>& values, double value) {
    const auto above = std::upper_bound(values.begin() + 1, values.end(), value);
    const auto low = static_cast<std::size_t>(above - values.begin()) - 1;
    return std::array{low, above == values.end() || values[low] == value ? low : low + 1};
  };
  const auto [t0, t1] = about(thetas, theta);
  const auto [a0, a1] = about(alphas, alpha);
  const auto reportOf = [&](std::size_t t, std::size_t a) -> const EntryReport& {
    return table.reports[t * alphas.size() + a];
  };
  if (thetas[t0] == theta && alphas[a0] == alpha) return reportOf(t0, a0).fit;

  const auto lobeAt = [](double angle, double roughness) {
    return GgxLobe(viewDirection(angle, 0.0), {roughness, roughness});
  };
  const auto fittedAt = [&](std::size_t t, std::size_t a) {
    const GgxLobe lobe = lobeAt(thetas[t], alphas[a]);
    const Eigen::Vector3d mean = computeMoments(lobe).mean;
    return FittedLobe{mean, measureLobeShape(lobe, mean), reportOf(t, a).fit.m};
  };
  const GgxLobe target = lobeAt(theta, alpha);
  const LobeMoments moments = computeMoments(target);
  const FittedLobe own{moments.mean, measureLobeShape(target, moments.mean)};
  EntryFit best = fitIsotropicEntry(target, moments, carried(fittedAt(t0, a1), own), entry);
  std::vector<std::array<std::size_t, 2>> corners;
  std::vector<double> errors;
  for (std::size_t t = t0; t <= t1; ++t) {
    for (std::size_t a = a0; a <= a1; ++a) {
      corners.push_back({t, a});
      errors.push_back(reportOf(t, a).fit.relativeL3);
    }
  }
  if (!isSuspicious(best, std::move(errors))) return best;
  std::vector<Matrix3d> starts;
  for (const auto& [t, a] : corners) starts.push_back(carried(fittedAt(t, a), own));
  starts.push_back(matrixOfShape(own.shape, own.mean));
  for (const Matrix3d& start : starts) {
    const EntryFit again = fitIsotropicEntry(target, moments, start, ofSecondTry(entry));
    if (isBetter(again, best)) best = again;
  }
  return best;
}

}  // namespace ltcfit
