#include "fit/table_refinement.h"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <exception>

#include "base/parallel_for.h"
#include "base/refusal.h"
#include "fit/ceres_termination.h"
#include "fit/refined_entry.h"
#include "fit/refinement_points.h"
#include "fit/refinement_problem.h"
#include "fit/table_plan.h"
#include "ggx/random.h"
#include "ltc/ltc.h"

namespace ltcfit {

using Eigen::Matrix3d;
using internal::RefinedLookUp;
using internal::RefinedLookUps;

namespace {

// At 0.4 one of 1,200 extreme look-ups of the 64^2 table lay below the horizon (alpha 2e-4, 89.5 degrees).
constexpr double kIsotropicSmoothness = 1.0;
constexpr double kRadius = 10.0;  // of the first trust region; a larger one takes failed steps first
constexpr double kCostTolerance = 1e-6;
// Of the linear solver: conjugate gradients stop at this part of the gradient, or after so many steps.
constexpr double kForcing = 0.1;
constexpr int kLinearIterations = 100;

// Each part over its mean among the direct fits of the points that are not nodes.
void setWeights(const std::vector<RefinementPoint>& points, const RefinementWeights& w,
                std::vector<RefinedLookUp>* lookUps) {
  LookUpErrors mean;
  double swRel = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].isNode) continue;
    const LookUpLoss& loss = *(*lookUps)[i].loss;
    mean.sw += points[i].weight * loss.direct().sw;
    mean.form += points[i].weight * loss.direct().form;
    mean.light += points[i].weight * loss.direct().light;
    swRel += points[i].weight * loss.direct().sw / loss.spread();
    total += points[i].weight;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    LookUpLoss& loss = *(*lookUps)[i].loss;
    const double sw =
        w.sw * total / mean.sw + w.swRel * total / (swRel * loss.spread()) + w.ratio / loss.direct().sw;
    const double light = w.light * total / mean.light + w.lightRatio / loss.direct().light;
    loss.setWeights(
        {points[i].weight * sw, points[i].weight * w.form * total / mean.form, points[i].weight * light});
  }
}

std::vector<double> parametersOf(const std::vector<RefinedEntry>& entries) {
  std::vector<double> out;
  for (const RefinedEntry& e : entries) out.insert(out.end(), e.parameters().begin(), e.parameters().end());
  return out;
}

void setParameters(const std::vector<double>& values, std::vector<RefinedEntry>* entries) {
  std::size_t size = 0;
  for (const RefinedEntry& e : *entries) size += e.size();
  if (size != values.size()) throw Refusal("the refinement to go on with is of another table");
  auto from = values.begin();
  for (RefinedEntry& e : *entries) {
    const auto to = from + static_cast<std::ptrdiff_t>(e.size());
    std::copy(from, to, e.parameters().begin());
    from = to;
    e.update();
  }
}

class Watch final : public ceres::IterationCallback {
 public:
  Watch(const RefinedLookUps& look, double lookUps, RefinementState* state, RefinementObserver* observer)
      : look_(look), lookUps_(lookUps), first_(state->iterations), state_(state), observer_(observer) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& s) override {
    state_->iterations = first_ + s.iteration;
    state_->radius = s.trust_region_radius;
    // after a step back the solver tells the cost that it was not taken for
    if (s.iteration == 0 || s.step_is_successful) state_->cost = s.cost / lookUps_;
    state_->parameters = parametersOf(look_.entries());
    if (observer_ == nullptr) return ceres::SOLVER_CONTINUE;
    try {
      observer_->iterated(*state_);
    } catch (...) {
      failure = std::current_exception();  // not through the solver
      return ceres::SOLVER_ABORT;
    }
    return ceres::SOLVER_CONTINUE;
  }

  std::exception_ptr failure;

 private:
  const RefinedLookUps& look_;
  double lookUps_;
  int first_;
  RefinementState* state_;
  RefinementObserver* observer_;
};

// Lobes there are, and room for what their symmetry leaves.
void checkTable(const Table& table, const TablePlan& plan) {
  const std::vector<std::string>& channels = table.info().channels;
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    const LobeParameters& p = plan.jobs[plan.nodes[n].job].parameters;
    if (!(p.alphaY > 0.0 && p.alphaX > 0.0 && p.alphaX <= 1.0))
      throw Refusal(fmt::format("node {} has alpha_x = {:g}, alpha_y = {:g}: no lobe of (0, 1]", n, p.alphaX,
                                p.alphaY));
    const Matrix3d free = projectOnFamily(Matrix3d::Ones(), plan.nodes[n].family);
    for (Eigen::Index k = 0; k < 9; ++k) {
      const std::string name = fmt::format("m{}{}", k / 3, k % 3);
      if (free(k / 3, k % 3) != 0.0 && std::find(channels.begin(), channels.end(), name) == channels.end())
        throw Refusal(fmt::format("node {} needs {}, which is no channel", n, name));
    }
  }
}

Table tableOf(const Table& table, const RefinedLookUps& look) {
  std::vector<float> data = table.data();
  const std::vector<std::string>& channels = table.info().channels;
  for (std::size_t n = 0; n < table.nodeCount(); ++n) {
    const NodeSource& source = look.plan().nodes[n];
    // turning leaves rounding where the node's own symmetry has zeros
    const Matrix3d m =
        projectOnFamily(turned(look.entries()[source.job].stored(), source.rotation), source.family);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      if (channels[c][0] == 'm')
        data[n * channels.size() + c] = static_cast<float>(m(channels[c][1] - '0', channels[c][2] - '0'));
    }
  }
  return Table(table.info(), std::move(data));
}

}  // namespace

RefinementOptions refinementDefaults(TableKind kind) {
  RefinementOptions o;
  if (kind == TableKind::kIsotropic) o.smoothness = kIsotropicSmoothness;
  return o;
}

bool RefinementOptions::isValid(std::string* error) const {
  const auto check = [&](bool ok, const std::string& message) {
    if (!ok) *error = message;
    return ok;
  };
  const auto within = [&](const char* name, double value, double high) {
    return check(value >= 0.0 && value <= high,
                 fmt::format("{} {:g}, must be in 0..{:g}", name, value, high));
  };
  const RefinementWeights& w = weights;
  return within("weight of sw", w.sw, 1e6) && within("weight of sw-rel", w.swRel, 1e6) &&
         within("weight of ratio", w.ratio, 1e6) && within("weight of form", w.form, 1e6) &&
         within("weight of light", w.light, 1e6) && within("weight of light-ratio", w.lightRatio, 1e6) &&
         check(w.sw + w.swRel + w.ratio + w.form + w.light + w.lightRatio > 0.0, "all weights are 0") &&
         check(points >= 16 && points <= 1 << 22,
               fmt::format("points = {}, must be in 16..4194304", points)) &&
         check(iterations >= 1 && iterations <= 1000,
               fmt::format("iterations = {}, must be in 1..1000", iterations)) &&
         within("node weight", nodeWeight, 1000.0) && within("smoothness", smoothness, 1000.0) &&
         within("prior", prior, 1000.0) &&
         check(threads >= 0, fmt::format("threads = {}, must be 0 or more", threads)) && loss.isValid(error);
}

RefinementResult refineTable(const Table& table, const RefinementOptions& o, const RefinementState* resumed,
                             RefinementObserver* observer) {
  const TableInfo& info = table.info();
  if (!table.isIsotropic() && info.stores != MatrixStorage::kM)
    throw Refusal("an anisotropic table is refined as it is looked up, by M: it stores Minv");
  const TablePlan plan = table.isIsotropic()
                             ? planIsotropicTable(info.axes, info.alphaFloor)
                             : planAnisotropicTable(info.axes, info.alphaFloor, SymmetryMode::kDuring);
  checkTable(table, plan);
  RefinedLookUps look(table, plan, o);
  RefinementState state;
  if (resumed != nullptr) {
    state = *resumed;
    if (!state.parameters.empty()) setParameters(state.parameters, &look.entries());
  }

  std::vector<RefinementPoint> points =
      refinementPoints(info, static_cast<std::size_t>(o.points), mixSeed(o.seed, 60), true);
  if (o.nodeWeight > 0.0) {
    // the first node of each lobe stands for all that have it
    std::vector<double> nodesOf(plan.jobs.size(), 0.0);
    for (const NodeSource& node : plan.nodes) nodesOf[node.job] += 1.0;
    std::size_t job = 0;
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
      if (plan.nodes[i].job != job) continue;
      points.push_back({plan.jobs[job].parameters, o.nodeWeight * nodesOf[job], true, i});
      ++job;
    }
  }
  look.prepare(points, info.brdf, o.loss, mixSeed(o.seed, 61), observer);
  setWeights(points, o.weights, &look.lookUps());

  ceres::Problem::Options problemOptions;
  problemOptions.evaluation_callback = &look;
  ceres::Problem problem(problemOptions);
  internal::addLookUpCosts(look, &problem);
  internal::addChangeCosts(table, o, look, &problem);

  ceres::Solver::Options so;
  so.linear_solver_type = ceres::CGNR;
  so.preconditioner_type = ceres::JACOBI;
  so.eta = kForcing;
  so.max_linear_solver_iterations = kLinearIterations;
  so.max_num_iterations = std::max(0, o.iterations - state.iterations);
  so.function_tolerance = kCostTolerance;
  so.initial_trust_region_radius = state.radius > 0.0 ? state.radius : kRadius;
  so.num_threads = 1;
  so.logging_type = ceres::SILENT;
  so.update_state_every_iteration = true;
  const double n = static_cast<double>(points.size());
  Watch watch(look, n, &state, observer);
  so.callbacks.push_back(&watch);
  ceres::Solver::Summary summary;
  ceres::Solve(so, &problem, &summary);
  if (watch.failure) std::rethrow_exception(watch.failure);
  for (RefinedEntry& e : look.entries()) e.update();

  RefinementResult out{.table = tableOf(table, look)};
  out.startCost = summary.initial_cost / n;
  out.state = state;
  out.termination = internal::terminationOf(summary.termination_type);
  for (std::size_t i = 0; i < out.table.nodeCount(); ++i) {
    const Matrix3d m = out.table.entry(out.table.node(i)).m;
    out.unusable += m.determinant() > 0.0 && isInvertibleInFloat(m) ? 0 : 1;
  }
  return out;
}

std::vector<FreshErrors> errorsAtFreshPoints(const std::vector<const Table*>& tables,
                                             const LookUpLossOptions& options, std::size_t count,
                                             std::uint64_t seed, int threads) {
  const TableInfo& info = tables.at(0)->info();
  const std::vector<RefinementPoint> points = refinementPoints(info, count, mixSeed(seed, 62), false);
  std::vector<FreshErrors> out(tables.size() + 1);
  const double each = 1.0 / static_cast<double>(count);
  std::vector<LookUpSamples> samples(static_cast<std::size_t>(threadCount(threads)), LookUpSamples(options));
  std::vector<std::vector<FreshErrors>> all(count, out);
  parallelFor(count, {.threads = threads}, [&](std::size_t i, std::size_t slot) {
    LookUpSamples& own = samples[slot];
    const LookUpLoss loss(points[i].parameters, info.brdf, options, mixSeed(mixSeed(seed, 63), i), own);
    for (std::size_t t = 0; t < out.size(); ++t) {
      FreshErrors& e = all[i][t];
      e.mean = loss.direct();
      if (t > 0) {
        const Matrix3d m = tables[t - 1]->fetch(points[i].parameters).m;
        const bool usable = LookUpLoss::isLtc(m);
        e.mean = usable ? loss.errors(m, own) : LookUpErrors{1.0, 1.0, 1.0};
        e.below = usable ? Ltc(m).massBelowHorizon() : 0.0;
        e.unusable = usable && m.determinant() > 0.0 ? 0 : 1;
      }
      e.swRel = e.mean.sw / loss.spread();
    }
  });
  for (const std::vector<FreshErrors>& point : all) {
    for (std::size_t t = 0; t < out.size(); ++t) {
      out[t].mean.sw += each * point[t].mean.sw;
      out[t].mean.form += each * point[t].mean.form;
      out[t].mean.light += each * point[t].mean.light;
      out[t].swRel += each * point[t].swRel;
      out[t].below += each * point[t].below;
      out[t].unusable += point[t].unusable;
    }
  }
  return out;
}

}  // namespace ltcfit
