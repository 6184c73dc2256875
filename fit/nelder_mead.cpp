#include "fit/nelder_mead.h"

#include <nlopt.h>

#include <cmath>
#include <memory>

#include "base/diagnostics.h"

namespace ltcfit {
namespace {

// What a non-finite cost is replaced by: finite, so that simplex arithmetic goes on, above every real cost.
constexpr double kBadCost = 1e300;

struct CallContext {
  const CostFunction* cost;
  OptimizerResult* result;
};

double evaluate(unsigned n, const double* x, double*, void* data) {
  auto& context = *static_cast<CallContext*>(data);
  OptimizerResult& r = *context.result;
  const double value = (*context.cost)({x, n});
  if (r.evaluations++ == 0) r.startCost = value;
  // Keep the best ourselves: what NLopt hands back after running out of evaluations is documented as the best
  // point, but a failure code leaves it open.
  if (std::isfinite(value) && (value < r.cost || !std::isfinite(r.cost))) {
    r.cost = value;
    r.parameters.assign(x, x + n);
  }
  return std::isfinite(value) ? value : kBadCost;
}

}  // namespace

std::string_view terminationName(Termination termination) {
  switch (termination) {
    case Termination::kConverged:
      return "converged";
    case Termination::kMaxEvaluations:
      return "max-evaluations";
    case Termination::kFailure:
      break;
  }
  return "failure";
}

bool NelderMeadOptions::isValid(std::string* error) const {
  if (maxEvaluations < 1) {
    *error = "maxEvaluations = " + std::to_string(maxEvaluations) + " must be at least 1";
    return false;
  }
  if (!(relativeCostTolerance > 0.0) || !(parameterTolerance > 0.0)) {
    *error = "tolerances must be greater than 0";
    return false;
  }
  return true;
}

OptimizerResult minimizeNelderMead(const CostFunction& cost, std::span<const double> start,
                                   std::span<const double> steps, const NelderMeadOptions& options) {
  std::string error;
  if (start.empty() || start.size() != steps.size() || !options.isValid(&error)) {
    abortWith("minimizeNelderMead: %zu parameters, %zu steps; %s", start.size(), steps.size(), error.c_str());
  }
  OptimizerResult result;
  result.parameters.assign(start.begin(), start.end());
  result.cost = std::nan("");
  CallContext context{&cost, &result};

  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> opt(
      nlopt_create(NLOPT_LN_NELDERMEAD, static_cast<unsigned>(start.size())), &nlopt_destroy);
  nlopt_set_min_objective(opt.get(), &evaluate, &context);
  nlopt_set_initial_step(opt.get(), steps.data());
  nlopt_set_maxeval(opt.get(), options.maxEvaluations);
  nlopt_set_ftol_rel(opt.get(), options.relativeCostTolerance);
  nlopt_set_xtol_abs1(opt.get(), options.parameterTolerance);
  std::vector<double> x(start.begin(), start.end());
  double best = 0.0;
  const nlopt_result code = nlopt_optimize(opt.get(), x.data(), &best);

  if (!std::isfinite(result.cost)) {
    result.termination = Termination::kFailure;
  } else if (code == NLOPT_MAXEVAL_REACHED) {
    result.termination = Termination::kMaxEvaluations;
  } else {
    // ROUNDOFF_LIMITED is a negative code, but says that no digit is left to gain
    const bool done = code > 0 || code == NLOPT_ROUNDOFF_LIMITED;
    result.termination = done ? Termination::kConverged : Termination::kFailure;
  }
  return result;
}

}  // namespace ltcfit
