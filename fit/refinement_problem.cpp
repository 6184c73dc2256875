#include "fit/refinement_problem.h"

#include <ceres/cost_function.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel_for.h"
#include "base/refusal.h"
#include "ggx/random.h"

namespace ltcfit::internal {

using Eigen::Matrix3d;
using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

namespace {

// Added to the curvature's diagonal, as a part of its trace: the scale of M and its rotation about z have
// none.
constexpr double kLeastCurvature = 1e-9;
constexpr int kResiduals = 10;

Matrix3d matrixOf(const Matrix3d& stored, MatrixStorage stores) {
  return stores == MatrixStorage::kM ? stored : Matrix3d(stored.inverse());
}

// A loss with gradient g and curvature H = L L^T as least squares: residuals L^-1 g, and one more that makes
// half their squares the loss, with derivatives L^T and 0. Gradient and Gauss-Newton matrix are then g and H.
class LookUpCost final : public ceres::CostFunction {
 public:
  LookUpCost(const RefinedLookUps& look, const RefinedLookUp& l) : look_(look), l_(l) {
    set_num_residuals(kResiduals);
    for (const std::size_t job : l.jobs)
      mutable_parameter_block_sizes()->push_back(static_cast<int>(look.entries()[job].size()));
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    if (!std::isfinite(l_.value)) return false;
    std::fill(residuals, residuals + kResiduals, 0.0);
    if (jacobians == nullptr) {
      residuals[kResiduals - 1] = std::sqrt(2.0 * l_.value);
      return true;
    }
    Eigen::Map<Vector9d>(residuals, 9) = l_.reduced;
    residuals[kResiduals - 1] = std::sqrt(std::max(0.0, 2.0 * l_.value - l_.reduced.squaredNorm()));
    // 0 for a look-up that is no LTC, whose inverse may not be finite
    const Matrix3d inverse = l_.isLtc ? Matrix3d(l_.stored.inverse()) : Matrix3d(Matrix3d::Zero());
    for (std::size_t b = 0; b < l_.jobs.size(); ++b) {
      if (jacobians[b] == nullptr) continue;
      const RefinedEntry& entry = look_.entries()[l_.jobs[b]];
      const auto n = static_cast<Eigen::Index>(entry.size());
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> j(jacobians[b],
                                                                                           kResiduals, n);
      j.setZero();
      for (Eigen::Index k = 0; k < n; ++k) {
        Matrix3d d = Matrix3d::Zero();
        for (std::size_t c = 0; c < l_.nodes.count; ++c) {
          const NodeSource& source = look_.plan().nodes[l_.nodes.node[c]];
          if (source.job != l_.jobs[b]) continue;
          d += l_.nodes.weight[c] * turned(entry.derivative(static_cast<std::size_t>(k)), source.rotation);
        }
        // P of M (I + P): M^-1 dM, and for N = M^-1 with dM = -M dN M
        const Matrix3d p =
            look_.stores() == MatrixStorage::kM ? Matrix3d(inverse * d) : Matrix3d(-d * inverse);
        Vector9d v;
        for (Eigen::Index i = 0; i < 9; ++i) v[i] = p(i / 3, i % 3);
        j.col(k).head<9>() = l_.factor * v;
      }
    }
    return true;
  }

 private:
  const RefinedLookUps& look_;
  const RefinedLookUp& l_;
};

// weight p, and weight (p - q): changes, and differences between neighbours'.
class ChangeCost final : public ceres::CostFunction {
 public:
  ChangeCost(std::size_t size, std::size_t blocks, double weight) : weight_(weight) {
    set_num_residuals(static_cast<int>(size));
    mutable_parameter_block_sizes()->assign(blocks, static_cast<int>(size));
  }

  bool Evaluate(double const* const* p, double* residuals, double** jacobians) const override {
    const std::size_t n = static_cast<std::size_t>(num_residuals());
    const std::size_t blocks = parameter_block_sizes().size();
    for (std::size_t k = 0; k < n; ++k) residuals[k] = weight_ * (p[0][k] - (blocks == 2 ? p[1][k] : 0.0));
    for (std::size_t b = 0; jacobians != nullptr && b < blocks; ++b) {
      if (jacobians[b] == nullptr) continue;
      std::fill(jacobians[b], jacobians[b] + n * n, 0.0);
      for (std::size_t k = 0; k < n; ++k) jacobians[b][k * (n + 1)] = b == 0 ? weight_ : -weight_;
    }
    return true;
  }

 private:
  double weight_;
};

}  // namespace

RefinedLookUps::RefinedLookUps(const Table& table, const TablePlan& plan, const RefinementOptions& options)
    : plan_(plan), form_{table.info().stores, table.info().normalization} {
  threads_ = threadCount(options.threads);
  for (int t = 0; t < threads_; ++t) samples_.emplace_back(options.loss);
  entries_.reserve(plan.jobs.size());
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    // nodes of one lobe: the first has it unturned
    if (plan.nodes[n].job != entries_.size()) continue;
    const NodeSource& node = plan.nodes[n];
    const Matrix3d m = projectOnFamily(turned(table.entry(table.node(n)).m, -node.rotation), node.jobFamily);
    if (!m.allFinite() || !(m.determinant() > 0.0))
      throw Refusal("node " + std::to_string(n) + " has no matrix with det > 0");
    entries_.emplace_back(m, node.jobFamily, form_);
  }
}

Matrix3d RefinedLookUps::storedAt(const LookUpNodes& nodes) const {
  Matrix3d sum = Matrix3d::Zero();
  for (std::size_t k = 0; k < nodes.count; ++k) {
    const NodeSource& source = plan_.nodes[nodes.node[k]];
    sum += nodes.weight[k] * turned(entries_[source.job].stored(), source.rotation);
  }
  return sum;
}

void RefinedLookUps::prepare(const std::vector<RefinementPoint>& points, const std::string& brdf,
                             const LookUpLossOptions& options, std::uint64_t seed,
                             RefinementObserver* observer) {
  lookUps_.resize(points.size());
  std::size_t done = 0;
  parallelFor(points.size(), {.threads = threads_}, [&](std::size_t i, std::size_t slot) {
    RefinedLookUp& l = lookUps_[i];
    l.nodes = points[i].isNode ? LookUpNodes{.node = {points[i].node}, .weight = {1.0}, .count = 1}
                               : lookUpNodes(plan_.info.axes, points[i].parameters);
    for (std::size_t k = 0; k < l.nodes.count; ++k) {
      const std::size_t job = plan_.nodes[l.nodes.node[k]].job;
      if (std::find(l.jobs.begin(), l.jobs.end(), job) == l.jobs.end()) l.jobs.push_back(job);
    }
    l.loss =
        std::make_unique<LookUpLoss>(points[i].parameters, brdf, options, mixSeed(seed, i), samples_[slot]);
    return [&] {
      if (observer != nullptr) observer->prepared(++done, points.size());
    };
  });
}

void RefinedLookUps::PrepareForEvaluation(bool jacobians, bool isNew) {
  if (isNew)
    for (RefinedEntry& e : entries_) e.update();
  parallelFor(lookUps_.size(), {.threads = threads_, .chunk = 16},
              [&](std::size_t i, std::size_t slot) { evaluate(lookUps_[i], jacobians, samples_[slot]); });
}

void RefinedLookUps::evaluate(RefinedLookUp& l, bool jacobians, LookUpSamples& samples) {
  l.stored = storedAt(l.nodes);
  const Matrix3d m = matrixOf(l.stored, form_.stores);
  l.isLtc = LookUpLoss::isLtc(m);
  if (!jacobians) {
    l.value = (*l.loss)(m, samples, nullptr);
    return;
  }
  LossDerivatives d;
  l.value = (*l.loss)(m, samples, &d);
  const double least = kLeastCurvature * d.curvature.trace() + std::numeric_limits<double>::min();
  d.curvature.diagonal().array() += least;
  const Eigen::LLT<Matrix9d> llt(d.curvature);
  l.factor = llt.matrixU();
  l.reduced = llt.matrixL().solve(d.gradient);
  // a steeper quadratic, where half the squares would be more than the loss: else the solver would compare
  // costs with and without derivatives that are not the same
  const double excess = l.reduced.squaredNorm() / (2.0 * l.value);
  if (excess > 1.0) {
    l.factor *= std::sqrt(excess);
    l.reduced /= std::sqrt(excess);
  }
}

void addLookUpCosts(RefinedLookUps& look, ceres::Problem* problem) {
  for (const RefinedLookUp& l : look.lookUps()) {
    std::vector<double*> blocks;
    for (const std::size_t job : l.jobs) blocks.push_back(look.entries()[job].parameters().data());
    problem->AddResidualBlock(new LookUpCost(look, l), nullptr, blocks);
  }
}

void addChangeCosts(const Table& table, const RefinementOptions& options, RefinedLookUps& look,
                    ceres::Problem* problem) {
  std::vector<RefinedEntry>& entries = look.entries();
  if (options.prior > 0.0) {
    for (RefinedEntry& e : entries)
      problem->AddResidualBlock(new ChangeCost(e.size(), 1, options.prior), nullptr, e.parameters().data());
  }
  if (!(options.smoothness > 0.0)) return;
  for (std::size_t n = 0; n < table.nodeCount(); ++n) {
    const std::vector<std::size_t> node = table.node(n);
    for (std::size_t a = 0; a < node.size(); ++a) {
      if (node[a] + 1 >= table.info().axes[a].size()) continue;
      std::vector<std::size_t> next = node;
      ++next[a];
      const std::size_t i = look.plan().nodes[n].job;
      const std::size_t j = look.plan().nodes[table.index(next) / table.channelCount()].job;
      if (i == j || entries[i].family() != entries[j].family()) continue;
      problem->AddResidualBlock(new ChangeCost(entries[i].size(), 2, options.smoothness), nullptr,
                                entries[i].parameters().data(), entries[j].parameters().data());
    }
  }
}
}  // namespace ltcfit::internal
