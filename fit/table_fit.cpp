#include "fit/table_fit.h"

#include <omp.h>

#include <Eigen/LU>
#include <algorithm>
#include <exception>
#include <memory>
#include <optional>

#include "fit/target_lobe.h"
#include "ltc/alignment.h"
#include "ltc/ltc.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;

// A light-space fit whose SW1 is so many times that of its start has lost the lobe.
constexpr double kWorstLoss = 1.5;

Matrix3d unitThirdColumn(const Matrix3d& m) {
  return normalized(m, MatrixNormalization::kThirdColumnUnit);
}

Matrix3d rounded(const Matrix3d& m) {
  return unitThirdColumn(m).cast<float>().cast<double>();
}

// The matrix of a node, before rounding.
Matrix3d nodeMatrix(const NodeSource& node, const JobResult& job) {
  return projectOnFamily(turned(projectOnFamily(job.m, node.jobFamily), node.rotation), node.family);
}

// body(i) for all i below n, on some threads; what it returns is called, one at a time. The first exception
// ends the loop and comes out of it (none may leave an OpenMP region).
template <class Body>
void parallelFor(std::size_t n, int threads, const Body& body) {
  std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (std::size_t i = 0; i < n; ++i) {
    bool stop = false;
#pragma omp critical(ltcfit_parallel_for)
    stop = failure != nullptr;
    if (stop) continue;
    std::optional<decltype(body(i))> after;
    std::exception_ptr thrown;
    try {
      after.emplace(body(i));
    } catch (...) {
      thrown = std::current_exception();
    }
#pragma omp critical(ltcfit_parallel_for)
    {
      try {
        if (thrown) std::rethrow_exception(thrown);
        if (!failure) (*after)();
      } catch (...) {
        if (!failure) failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

std::string_view fitterName(Fitter fitter) {
  switch (fitter) {
    case Fitter::kSlicedWassersteinSgd:
      return "sw-sgd";
    case Fitter::kL3:
      return "l3";
    case Fitter::kLight:
      return "light";
    case Fitter::kSlicedWasserstein:
      break;
  }
  return "sw";
}

bool TableFitOptions::isValid(std::string* error) const {
  return sw.isValid(error) && sgd.isValid(error) && light.isValid(error) && l3.nelderMead.isValid(error);
}

JobResult fitJob(const LobeJob& job, std::string_view brdf, const TableFitOptions& options) {
  const std::unique_ptr<Lobe> lobe = makeTargetLobe(brdf, job.parameters);
  const LobeMoments moments = computeMoments(*lobe);
  JobResult r;
  r.norm = moments.albedo;
  r.fresnel = moments.fresnel;
  r.momentError = moments.error;

  // fewer slices do for a matrix of the family; a stochastic descent leaves it
  const MatrixFamily judged =
      options.fitter == Fitter::kSlicedWassersteinSgd ? MatrixFamily::kGeneral : job.family;
  const SlicedWassersteinTarget target = makeTarget(*lobe, judged, options.sw);
  ProjectedCdfLoss judge = makeLoss(target, options.sw.levels.back(), options.sw.seed);
  r.startLoss = judge(target.start, nullptr);
  Matrix3d m;
  switch (options.fitter) {
    case Fitter::kSlicedWasserstein: {
      const SlicedWassersteinFit fit = fitSlicedWasserstein(target, target.start, options.sw, judge);
      m = fit.m;
      r.evaluations = fit.evaluations;
      r.termination = fit.termination;
      break;
    }
    case Fitter::kSlicedWassersteinSgd: {
      const SgdResult fit = descendSlicedWasserstein(*lobe, target.start, options.sgd);
      m = fit.m;
      r.evaluations = options.sgd.steps;
      r.termination = fit.finite ? Termination::kConverged : Termination::kFailure;
      break;
    }
    case Fitter::kL3: {
      const EntryFit fit = fitL3Entry(*lobe, moments.albedo, job.family, target.start, options.l3);
      m = fit.m;
      r.evaluations = fit.evaluations;
      r.termination = fit.termination;
      break;
    }
    case Fitter::kLight: {
      const ContourIntegrator truth(*lobe);
      const LightTarget lights{truth, moments.albedo, job.family, target.start};
      const LightFit fit = fitLights(lights, target.start, options.light);
      m = fit.m;
      r.evaluations = fit.evaluations;
      r.termination = fit.termination;
      r.integralError = fit.integralError;
      // Lights that do not hold the lobe: the other fit does.
      if (fit.termination == Termination::kFailure || judge(m, nullptr) > kWorstLoss * r.startLoss) {
        const SlicedWassersteinFit sw = fitSlicedWasserstein(target, target.start, options.sw, judge);
        m = sw.m;
        r.evaluations += sw.evaluations;
        r.termination = sw.termination;
      }
      break;
    }
  }
  r.fitted = m.allFinite() && m.determinant() != 0.0;
  if (!r.fitted) return r;
  if (m.determinant() < 0.0) m.col(1) *= -1.0;
  m = unitThirdColumn(m);
  r.loss = judge(m, nullptr);

  const Alignment aligned = align(m);
  r.m = aligned.m;
  r.distanceBefore = aligned.distanceBefore;
  r.distanceAfter = aligned.distanceAfter;
  r.alignmentStrength = aligned.strength;
  r.flipWouldBeCloser = aligned.flipWouldBeCloser;
  r.alignedLoss = r.m == m ? r.loss : judge(r.m, nullptr);
  const Matrix3d symmetric = projectOnFamily(r.m, familyOf(job.parameters));
  r.symmetricLoss = symmetric == r.m ? r.alignedLoss : judge(symmetric, nullptr);
  r.storedLoss = judge(rounded(symmetric), nullptr);
  return r;
}

TableFitResult fitTable(const TablePlan& plan, SymmetryMode symmetry, const TableFitOptions& options,
                        JobStore* store, const TableFitProgress& progress) {
  TableFitResult result;
  const std::size_t n = plan.jobs.size();
  result.jobs.resize(n);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < n; ++i) {
    const JobResult* const known = store != nullptr ? store->find(i) : nullptr;
    if (known != nullptr) {
      result.jobs[i] = *known;
    } else {
      open.push_back(i);
    }
  }
  const int threads = options.threads > 0 ? options.threads : omp_get_max_threads();
  std::size_t done = n - open.size();
  parallelFor(open.size(), threads, [&](std::size_t k) {
    const std::size_t i = open[k];
    result.jobs[i] = fitJob(plan.jobs[i], plan.info.brdf, options);
    return [&, i] {
      if (store != nullptr) store->add(i, result.jobs[i]);
      if (progress) progress(++done, n);
    };
  });
  if (symmetry == SymmetryMode::kAfter) {
    parallelFor(n, threads, [&](std::size_t i) {
      const std::unique_ptr<Lobe> lobe = makeTargetLobe(plan.info.brdf, plan.jobs[i].parameters);
      ProjectedCdfLoss judge = makeLoss(makeTarget(*lobe, plan.jobs[i].family, options.sw),
                                        options.sw.levels.back(), options.sw.seed);
      const Matrix3d m = nodeMatrix(plan.nodes[i], result.jobs[plan.nodes[i].job]);
      result.jobs[i].symmetricLoss = judge(m, nullptr);
      result.jobs[i].storedLoss = judge(rounded(m), nullptr);
      return [] {};
    });
  }

  const std::vector<std::string>& channels = plan.info.channels;
  for (const NodeSource& node : plan.nodes) {
    const JobResult& job = result.jobs[node.job];
    const Matrix3d m = rounded(nodeMatrix(node, job));
    for (const std::string& c : channels) {
      double value = 0.0;
      if (c == "norm") {
        value = job.norm;
      } else if (c == "fresnel") {
        value = job.fresnel;
      } else {
        value = m(c[1] - '0', c[2] - '0');
      }
      result.data.push_back(static_cast<float>(value));
    }
    const bool usable = job.fitted && m.determinant() > 0.0 && isInvertibleInFloat(m);
    result.nodeUsable.push_back(usable);
    result.unusable += usable ? 0 : 1;
  }
  for (const JobResult& job : result.jobs) {
    result.notConverged += job.termination == Termination::kConverged ? 0 : 1;
    result.weaklyAligned += job.alignmentStrength < kWeakAlignment ? 1 : 0;
    result.evaluations += job.evaluations;
    result.largestIntegralError = std::max(result.largestIntegralError, job.integralError);
    result.largestMomentError = std::max(result.largestMomentError, job.momentError);
  }
  return result;
}

}  // namespace ltcfit
