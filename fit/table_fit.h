// Fits all lobes of a plan and makes the table of them: align, symmetrise, normalise.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fit/lobe_fit.h"
#include "fit/table_plan.h"

namespace ltcfit {

struct TableFitOptions : LobeFitOptions {
  int threads = 0;  ///< 0: as many as OpenMP offers
};

/// One fitted lobe. Losses are SW1 by the samples of `TableFitOptions::sw` (its last level), for every
/// fitter.
struct JobResult {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();  ///< as fitted, then aligned; third column of length 1
  double startLoss = 0.0;                           ///< of the start, momentStart()
  double loss = 0.0;                                ///< as fitted
  double alignedLoss = 0.0;     ///< after alignment, which leaves the lobe as it is: equal to sampling noise
  double symmetricLoss = 0.0;   ///< after the entries that must vanish were set to 0 (eq. 16)
  double storedLoss = 0.0;      ///< after normalisation and rounding to float32
  double distanceBefore = 0.0;  ///< eq. 12 before and after alignment
  double distanceAfter = 0.0;
  double alignmentStrength = 0.0;  ///< Alignment::strength
  bool flipWouldBeCloser = false;
  double norm = 0.0;           ///< n_D
  double fresnel = 0.0;        ///< f_D
  double momentError = 0.0;    ///< estimated absolute error of the two
  double integralError = 0.0;  ///< kLight: estimated largest error of the true light integrals
  int evaluations = 0;
  Termination termination = Termination::kFailure;  ///< LobeFit::termination
  bool fitted = false;                              ///< the matrix is finite and has an inverse
};

struct TableFitResult {
  std::vector<float> data;        ///< for Table, in the channels of the plan
  std::vector<JobResult> jobs;    ///< in the order of the plan
  std::vector<bool> nodeUsable;   ///< det > 0 and invertible in float32
  std::size_t unusable = 0;       ///< nodes that are not
  std::size_t notConverged = 0;   ///< jobs that used up their iterations or failed
  std::size_t weaklyAligned = 0;  ///< jobs of alignment strength below kWeakAlignment
  long long evaluations = 0;
  double largestMomentError = 0.0;
  double largestIntegralError = 0.0;
};

/// Below this (Alignment::strength) the angle of eq. 12 is chosen by little: neighbours may differ by more
/// than they should.
inline constexpr double kWeakAlignment = 0.3;

/// Where finished jobs are kept, so that a killed run loses none: see checkpoint.h.
class JobStore {
 public:
  virtual ~JobStore() = default;
  /// The result of an earlier run, or null.
  virtual const JobResult* find(std::size_t job) const = 0;
  /// Called once for each job that was fitted, from any thread but never from two at once.
  virtual void add(std::size_t job, const JobResult& result) = 0;
};

/// Called after each finished job, from any thread but never from two at once.
using TableFitProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Fits one lobe: a function of its arguments alone, so that neither threads nor interruptions show.
JobResult fitJob(const LobeJob& job, std::string_view brdf, const LobeFitOptions& options);

/// A lobe fitted alone, as a node of a table has it.
struct NodeFit {
  Eigen::Matrix3d m =
      Eigen::Matrix3d::Identity();  ///< aligned, of the lobe's symmetry, third column of length 1
  double norm = 0.0;
  double fresnel = 0.0;
  bool usable = false;  ///< finite, det > 0
};

/// Fits the one node of a plan: what fitTable makes of it in SymmetryMode::kDuring, up to rounding to
/// float32, without the figures of JobResult, which cost more than the fit.
NodeFit fitNode(const TablePlan& plan, std::size_t node, const LobeFitOptions& options);

/// The same of a node alone, in the mode that it was planned for.
NodeFit fitNode(const NodePlan& node, std::string_view brdf, const LobeFitOptions& options);

/// Fits every job of the plan that `store` (may be null) does not have, and makes the nodes. In
/// SymmetryMode::kAfter, where jobs are nodes, symmetricLoss and storedLoss are of the node's final matrix,
/// which another job's may be. `options` must be valid. Exceptions of the store come through.
TableFitResult fitTable(const TablePlan& plan, SymmetryMode symmetry, const TableFitOptions& options,
                        JobStore* store, const TableFitProgress& progress = {});

}  // namespace ltcfit
