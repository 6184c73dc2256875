#include "fit/table_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <memory>

#include "base/parallel_for.h"
#include "fit/target_lobe.h"
#include "ltc/alignment.h"
#include "ltc/ltc.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;

Matrix3d unitThirdColumn(const Matrix3d& m) {
  return normalized(m, MatrixNormalization::kThirdColumnUnit);
}

Matrix3d rounded(const Matrix3d& m) {
  return unitThirdColumn(m).cast<float>().cast<double>();
}

bool hasInverse(const Matrix3d& m) {
  return m.allFinite() && m.determinant() != 0.0;
}

// Of the same lobe: det > 0, third column of length 1.
Matrix3d canonical(Matrix3d m) {
  if (m.determinant() < 0.0) m.col(1) *= -1.0;
  return unitThirdColumn(m);
}

// The matrix of a node, before rounding, from its job's aligned one.
Matrix3d nodeMatrix(const NodeSource& node, const Matrix3d& m) {
  return projectOnFamily(turned(projectOnFamily(m, node.jobFamily), node.rotation), node.family);
}

}  // namespace

JobResult fitJob(const LobeJob& job, std::string_view brdf, const LobeFitOptions& options) {
  LobeFitTarget target(job, brdf, options);
  ProjectedCdfLoss& judge = target.judge();
  JobResult r;
  r.norm = target.moments().albedo;
  r.fresnel = target.moments().fresnel;
  r.momentError = target.moments().error;
  r.startLoss = judge(target.momentStart(), nullptr);
  const LobeFit fit = fitLobe(target, target.momentStart(), options);
  r.evaluations = fit.evaluations;
  r.termination = fit.termination;
  r.integralError = fit.integralError;
  r.fitted = hasInverse(fit.m);
  if (!r.fitted) return r;
  const Matrix3d m = canonical(fit.m);
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

NodeFit fitNode(const TablePlan& plan, std::size_t node, const LobeFitOptions& options) {
  const NodeSource& source = plan.nodes[node];
  return fitNode({plan.jobs[source.job], source}, plan.info.brdf, options);
}

NodeFit fitNode(const NodePlan& node, std::string_view brdf, const LobeFitOptions& options) {
  LobeFitTarget target(node.job, brdf, options);
  const LobeFit fit = fitLobe(target, target.momentStart(), options);
  NodeFit out;
  out.norm = target.moments().albedo;
  out.fresnel = target.moments().fresnel;
  if (!hasInverse(fit.m)) return out;
  out.m = unitThirdColumn(nodeMatrix(node.source, align(canonical(fit.m)).m));
  out.usable = out.m.allFinite() && out.m.determinant() > 0.0;
  return out;
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
  const ParallelOptions parallel{.threads = options.threads};
  std::size_t done = n - open.size();
  parallelFor(open.size(), parallel, [&](std::size_t k) {
    const std::size_t i = open[k];
    result.jobs[i] = fitJob(plan.jobs[i], plan.info.brdf, options);
    return [&, i] {
      if (store != nullptr) store->add(i, result.jobs[i]);
      if (progress) progress(++done, n);
    };
  });
  if (symmetry == SymmetryMode::kAfter) {
    parallelFor(n, parallel, [&](std::size_t i) {
      const std::unique_ptr<Lobe> lobe = makeTargetLobe(plan.info.brdf, plan.jobs[i].parameters);
      ProjectedCdfLoss judge = makeLoss(makeTarget(*lobe, plan.jobs[i].family, options.sw),
                                        options.sw.levels.back(), options.sw.seed);
      const Matrix3d m = nodeMatrix(plan.nodes[i], result.jobs[plan.nodes[i].job].m);
      result.jobs[i].symmetricLoss = judge(m, nullptr);
      result.jobs[i].storedLoss = judge(rounded(m), nullptr);
    });
  }

  const std::vector<std::string>& channels = plan.info.channels;
  for (const NodeSource& node : plan.nodes) {
    const JobResult& job = result.jobs[node.job];
    const Matrix3d m = rounded(nodeMatrix(node, job.m));
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
