#include "fit/bfgs.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ltcfit {
namespace {

double rosenbrock(std::span<const double> x, double* g) {
  const double a = x[1] - x[0] * x[0];
  if (g != nullptr) {
    g[0] = -400.0 * x[0] * a - 2.0 * (1.0 - x[0]);
    g[1] = 200.0 * a;
  }
  return 100.0 * a * a + (1.0 - x[0]) * (1.0 - x[0]);
}

TEST(Bfgs, FindsTheMinimumOfACurvedValley) {
  const std::vector<double> start{-1.2, 1.0};
  const OptimizerResult r = minimizeBfgs(rosenbrock, start, {200, 1e-12});
  EXPECT_EQ(r.termination, Termination::kConverged);
  EXPECT_NEAR(r.parameters[0], 1.0, 1e-4);
  EXPECT_NEAR(r.parameters[1], 1.0, 1e-4);
  EXPECT_DOUBLE_EQ(r.startCost, rosenbrock(start, nullptr));
  EXPECT_NEAR(r.cost, rosenbrock(r.parameters, nullptr), 1e-15);
  EXPECT_GT(r.evaluations, 5);
}

TEST(Bfgs, StepsBackFromValuesThatAreNotFinite) {
  // minimum at 1, nothing beyond 1.5; the first step is tempted far beyond
  const GradientCostFunction cost = [](std::span<const double> x, double* g) {
    if (x[0] > 1.5) return std::nan("");
    if (g != nullptr) g[0] = 40.0 * (x[0] - 1.0);
    return 20.0 * (x[0] - 1.0) * (x[0] - 1.0);
  };
  const OptimizerResult r = minimizeBfgs(cost, std::vector<double>{-3.0}, {});
  EXPECT_NEAR(r.parameters[0], 1.0, 1e-3);
}

TEST(Bfgs, SaysWhyItStopped) {
  EXPECT_EQ(minimizeBfgs(rosenbrock, std::vector<double>{-1.2, 1.0}, {2, 1e-12}).termination,
            Termination::kMaxEvaluations);
  const GradientCostFunction nothing = [](std::span<const double>, double*) { return std::nan(""); };
  const OptimizerResult r = minimizeBfgs(nothing, std::vector<double>{0.5}, {});
  EXPECT_EQ(r.termination, Termination::kFailure);
  EXPECT_EQ(r.parameters[0], 0.5);
  const GradientCostFunction flat = [](std::span<const double>, double* g) {
    if (g != nullptr) g[0] = 0.0;
    return 3.0;
  };
  EXPECT_EQ(minimizeBfgs(flat, std::vector<double>{0.5}, {}).termination, Termination::kConverged);
}

TEST(BfgsOptions, AreChecked) {
  std::string error;
  EXPECT_TRUE(BfgsOptions{}.isValid(&error));
  EXPECT_FALSE((BfgsOptions{0, 1e-5}.isValid(&error)));
  EXPECT_FALSE((BfgsOptions{10, 0.0}.isValid(&error)));
  EXPECT_FALSE((BfgsOptions{10, std::nan("")}.isValid(&error)));
}

}  // namespace
}  // namespace ltcfit
