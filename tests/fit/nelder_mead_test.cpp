#include "fit/nelder_mead.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ltcfit {
namespace {

double rosenbrock(std::span<const double> x) {
  return 100.0 * std::pow(x[1] - x[0] * x[0], 2) + std::pow(1.0 - x[0], 2);
}

const std::vector<double> kStart{-1.2, 1.0};
const std::vector<double> kSteps{0.2, 0.2};

TEST(NelderMead, FindsTheMinimum) {
  const OptimizerResult r = minimizeNelderMead(rosenbrock, kStart, kSteps, {});
  EXPECT_EQ(r.termination, Termination::kConverged);
  EXPECT_NEAR(r.parameters[0], 1.0, 1e-3);
  EXPECT_NEAR(r.parameters[1], 1.0, 1e-3);
  EXPECT_DOUBLE_EQ(r.startCost, 24.2);
  EXPECT_DOUBLE_EQ(r.cost, rosenbrock(r.parameters));
}

TEST(NelderMead, RunningOutIsReportedAndKeepsTheBest) {
  NelderMeadOptions options;
  options.maxEvaluations = 12;
  const OptimizerResult r = minimizeNelderMead(rosenbrock, kStart, kSteps, options);
  EXPECT_EQ(r.termination, Termination::kMaxEvaluations);
  EXPECT_EQ(r.evaluations, 12);
  EXPECT_LT(r.cost, r.startCost);
  EXPECT_DOUBLE_EQ(r.cost, rosenbrock(r.parameters));
}

TEST(NelderMead, AvoidsValuesThatAreNotFinite) {
  const auto cliff = [](std::span<const double> x) {
    if (x[0] < 0.0) return std::nan("");
    return x[0] > 3.0 ? std::numeric_limits<double>::infinity() : std::pow(x[0] - 0.01, 2);
  };
  const OptimizerResult r = minimizeNelderMead(cliff, std::vector{2.0}, std::vector{1.5}, {});
  EXPECT_EQ(r.termination, Termination::kConverged);
  EXPECT_NEAR(r.parameters[0], 0.01, 1e-3);
}

TEST(NelderMead, NothingFiniteIsAFailure) {
  const auto nothing = [](std::span<const double>) { return std::nan(""); };
  const OptimizerResult r = minimizeNelderMead(nothing, kStart, kSteps, {});
  EXPECT_EQ(r.termination, Termination::kFailure);
  EXPECT_EQ(r.parameters, kStart);
}

TEST(NelderMead, AFlatCostConverges) {
  const OptimizerResult r =
      minimizeNelderMead([](std::span<const double>) { return 1.0; }, kStart, kSteps, {});
  EXPECT_EQ(r.termination, Termination::kConverged);
  EXPECT_EQ(r.cost, 1.0);
}

TEST(NelderMead, OptionsAreChecked) {
  std::string error;
  EXPECT_TRUE(NelderMeadOptions{}.isValid(&error));
  NelderMeadOptions none;
  none.maxEvaluations = 0;
  EXPECT_FALSE(none.isValid(&error));
  EXPECT_NE(error.find("maxEvaluations = 0"), std::string::npos);
  NelderMeadOptions loose;
  loose.parameterTolerance = -1.0;
  EXPECT_FALSE(loose.isValid(&error));
  EXPECT_DEATH(minimizeNelderMead(rosenbrock, kStart, {}, {}), "2 parameters, 0 steps");
}

}  // namespace
}  // namespace ltcfit
