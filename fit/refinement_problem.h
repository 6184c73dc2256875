// The least-squares problem of joint refinement: the entries, their look-ups, and what these cost. Internal
// to fit/.
#pragma once

#include <ceres/evaluation_callback.h>
#include <ceres/problem.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fit/lookup_loss.h"
#include "fit/refined_entry.h"
#include "fit/refinement_points.h"
#include "fit/table_plan.h"
#include "fit/table_refinement.h"
#include "ltc/table.h"

namespace ltcfit::internal {

/// A look-up as the solver sees it.
struct RefinedLookUp {
  std::unique_ptr<LookUpLoss> loss;
  LookUpNodes nodes;
  std::vector<std::size_t> jobs;  ///< of its nodes, each once
  // at the last evaluation
  double value = 0.0;
  bool isLtc = false;
  Eigen::Matrix3d stored;               ///< interpolated
  Eigen::Matrix<double, 9, 9> factor;   ///< L^T of the curvature L L^T
  Eigen::Matrix<double, 9, 1> reduced;  ///< L^-1 gradient
};

/// The entries and their look-ups. All look-ups are evaluated here, on all threads, before the solver asks
/// for their residuals one by one: its own threads would add them up in any order.
class RefinedLookUps final : public ceres::EvaluationCallback {
 public:
  /// One entry for each job of the plan, as `table` has it. Throws Refusal for a node without a
  /// matrix of det > 0. `plan` must outlive it.
  RefinedLookUps(const Table& table, const TablePlan& plan, const RefinementOptions& options);

  std::vector<RefinedEntry>& entries() { return entries_; }
  const std::vector<RefinedEntry>& entries() const { return entries_; }
  std::vector<RefinedLookUp>& lookUps() { return lookUps_; }
  const std::vector<RefinedLookUp>& lookUps() const { return lookUps_; }
  const TablePlan& plan() const { return plan_; }
  MatrixStorage stores() const { return form_.stores; }

  /// Makes the look-ups. Exceptions of the observer come through.
  void prepare(const std::vector<RefinementPoint>& points, const std::string& brdf,
               const LookUpLossOptions& options, std::uint64_t seed, RefinementObserver* observer);

  void PrepareForEvaluation(bool jacobians, bool isNew) override;

 private:
  Eigen::Matrix3d storedAt(const LookUpNodes& nodes) const;
  void evaluate(RefinedLookUp& l, bool jacobians, LookUpSamples& samples);

  const TablePlan& plan_;
  StoredForm form_;
  int threads_;
  std::vector<LookUpSamples> samples_;  // one for each slot of a parallel loop
  std::vector<RefinedEntry> entries_;
  std::vector<RefinedLookUp> lookUps_;
};

/// Adds the loss of each look-up, and what changes of the entries and differences between neighbours' changes
/// cost. `look` must outlive the problem, of which it is the evaluation callback.
void addLookUpCosts(RefinedLookUps& look, ceres::Problem* problem);
void addChangeCosts(const Table& table, const RefinementOptions& options, RefinedLookUps& look,
                    ceres::Problem* problem);

}  // namespace ltcfit::internal
