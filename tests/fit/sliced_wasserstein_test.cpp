#include "fit/sliced_wasserstein.h"

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fit/lobe_samples.h"
#include "fit/matrix_family.h"
#include "fit/sorted_projections.h"
#include "ggx/ggx_lobe.h"
#include "ltc/ltc.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<Vector3d> randomCosine(int n, Random& random) {
  std::vector<Vector3d> out;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform();
    out.push_back(sampleCosine({u, random.uniform()}));
  }
  return out;
}

std::vector<Vector3d> randomSlices(int n, Random& random) {
  std::vector<Vector3d> out;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    const double y = random.normal();
    out.push_back(Vector3d(x, y, random.normal()).normalized());
  }
  return out;
}

Matrix3d someMatrix(Random& random, double aperture) {
  Matrix3d m = Matrix3d::Identity();
  for (int k = 0; k < 9; ++k) m(k / 3, k % 3) += 0.3 * random.normal();
  m.leftCols<2>() *= aperture;
  return m;
}

struct Problem {
  explicit Problem(double alpha, double theta, double aperture, int n = 200, int slices = 8) : random(3) {
    const GgxLobe lobe(viewDirection(theta, 0.4), {alpha, 0.5 * alpha});
    const std::vector<Vector3d> target = rejectionSamples(lobe, n, random);
    cosine = randomCosine(n, random);
    loss.setTarget(target, randomSlices(slices, random));
    m = someMatrix(random, aperture);
  }
  Random random;
  std::vector<Vector3d> cosine;
  SlicedWasserstein loss;
  Matrix3d m;
};

TEST(SlicedWasserstein, IsZeroForTheSameSamples) {
  Random random(1);
  const std::vector<Vector3d> cosine = randomCosine(300, random);
  SlicedWasserstein loss;
  loss.setTarget(cosine, randomSlices(20, random));
  Matrix3d gradient;
  EXPECT_NEAR(loss.evaluate(Matrix3d::Identity(), cosine, &gradient), 0.0, 1e-15);
  EXPECT_TRUE(gradient.allFinite());
  EXPECT_NEAR(loss.evaluate(7.0 * Matrix3d::Identity(), cosine, nullptr), 0.0, 1e-15) << "scale";
}

TEST(SlicedWasserstein, IsTheMeanDistanceOfSortedProjections) {
  Random random(2);
  const std::vector<Vector3d> target = randomCosine(101, random);
  const std::vector<Vector3d> cosine = randomCosine(101, random);
  const std::vector<Vector3d> slices = randomSlices(5, random);
  const Matrix3d m = someMatrix(random, 0.3);
  SlicedWasserstein loss;
  loss.setTarget(target, slices);
  double sum = 0.0;
  for (const Vector3d& w : slices) {
    std::vector<double> f;
    std::vector<double> g;
    for (std::size_t i = 0; i < target.size(); ++i) {
      f.push_back(w.dot((m * cosine[i]).normalized()));
      g.push_back(w.dot(target[i]));
    }
    std::sort(f.begin(), f.end());
    std::sort(g.begin(), g.end());
    for (std::size_t i = 0; i < f.size(); ++i) sum += std::abs(f[i] - g[i]) / (5.0 * 101.0);
  }
  // keys are float32: two projections that it cannot tell apart may change places
  EXPECT_NEAR(loss.evaluate(m, cosine, nullptr), sum, 1e-8);
}

// Largest deviation of the gradient from central differences, relative to its length. Steps so short that no
// two projections change ranks, so that the loss is smooth over them.
double gradientError(Problem& p, const Matrix3d& gradient) {
  double worst = 0.0;
  for (int k = 0; k < 9; ++k) {
    const double h = 1e-8 * (k % 3 == 2 ? 1.0 : p.m.leftCols<2>().norm());
    Matrix3d up = p.m;
    Matrix3d down = p.m;
    up(k / 3, k % 3) += h;
    down(k / 3, k % 3) -= h;
    const double difference =
        (p.loss.evaluate(up, p.cosine, nullptr) - p.loss.evaluate(down, p.cosine, nullptr)) / (2.0 * h);
    worst = std::max(worst, std::abs(difference - gradient(k / 3, k % 3)));
  }
  return worst / gradient.norm();
}

TEST(SlicedWasserstein, GradientAgreesWithDifferencesAndAWrongOneDoesNot) {
  for (const auto& [alpha, theta, aperture] :
       {std::array{0.8, 0.2, 1.0}, std::array{0.3, 1.2, 0.3}, std::array{0.01, 1.5, 0.05}}) {
    Problem p(alpha, theta, aperture);
    Matrix3d gradient;
    p.loss.evaluate(p.m, p.cosine, &gradient);
    // differences of a loss of order 1 over steps of 1e-8 keep some six digits
    EXPECT_LT(gradientError(p, gradient), 2e-5) << alpha;
    EXPECT_GT(gradientError(p, 1.01 * gradient), 1e-3) << "a factor";
    EXPECT_GT(gradientError(p, gradient.transpose()), 1e-2) << "rows for columns";
    // without the derivative of the normalisation there is a part along M itself
    EXPECT_GT(gradientError(p, gradient + 0.01 * gradient.norm() / p.m.norm() * p.m), 1e-3);
  }
}

// Ceres' checker takes residuals: the loss is one.
class LossCost final : public ceres::CostFunction {
 public:
  LossCost(Problem& problem, double factor) : problem_(problem), factor_(factor) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(9);
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    const Matrix3d m = Eigen::Map<const RowMajor>(parameters[0]);
    Matrix3d gradient;
    residuals[0] = problem_.loss.evaluate(m, problem_.cosine, &gradient);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      gradient(1, 2) *= factor_;
      Eigen::Map<RowMajor> jacobian(jacobians[0]);
      jacobian = gradient;
    }
    return true;
  }

 private:
  Problem& problem_;
  double factor_;
};

TEST(SlicedWasserstein, PassesCeresGradientChecker) {
  Problem p(0.4, 0.9, 0.4);
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> m = p.m;
  const double* const parameters[] = {m.data()};
  ceres::NumericDiffOptions options;
  // too short for any two projections to change ranks
  options.ridders_relative_initial_step_size = 1e-8;
  options.max_num_ridders_extrapolations = 1;
  for (const double factor : {1.0, 1.1}) {
    LossCost cost(p, factor);
    const ceres::GradientChecker checker(
        &cost, static_cast<const std::vector<const ceres::Manifold*>*>(nullptr), options);
    ceres::GradientChecker::ProbeResults results;
    EXPECT_EQ(checker.Probe(parameters, 1e-4, &results), factor == 1.0) << results.error_log;
  }
}

TEST(SlicedWasserstein, SurvivesTiesAndSingularMatrices) {
  Random random(5);
  const std::vector<Vector3d> one(64, Vector3d(0.6, 0.0, 0.8));  // all projections tie
  SlicedWasserstein loss;
  loss.setTarget(one, randomSlices(6, random));
  Matrix3d gradient;
  const std::vector<Vector3d> zenith(64, Vector3d::UnitZ());
  EXPECT_TRUE(std::isfinite(loss.evaluate(Matrix3d::Identity(), zenith, &gradient)));
  EXPECT_TRUE(gradient.allFinite());
  Matrix3d flat = Matrix3d::Zero();
  flat.col(2) = one[0];
  EXPECT_NEAR(loss.evaluate(flat, zenith, &gradient), 0.0, 1e-15);
  EXPECT_TRUE(gradient.allFinite());
}

TEST(SlicedWassersteinDeath, CountsMustAgree) {
  SlicedWasserstein loss;
  const std::vector<Vector3d> samples(4, Vector3d::UnitZ());
  loss.setTarget(samples, samples);
  EXPECT_DEATH(loss.evaluate(Matrix3d::Identity(), std::vector<Vector3d>(3, Vector3d::UnitZ()), nullptr),
               "3 cosine samples for 4");
}

TEST(ProjectionSorter, SortsLikeAStableSort) {
  Random random(7);
  ProjectionSorter sorter;
  for (const std::size_t n : {1u, 2u, 17u, 2048u, 5000u}) {
    std::vector<double> values(n);
    for (double& v : values)
      v = std::round(20.0 * (2.0 * random.uniform() - 1.0)) / 20.0;  // many ties, both signs
    std::vector<std::uint32_t> expected(n);
    std::iota(expected.begin(), expected.end(), 0u);
    std::stable_sort(expected.begin(), expected.end(), [&](auto a, auto b) { return values[a] < values[b]; });
    const std::span<const std::uint32_t> order = sorter.order(values, 0.05);
    EXPECT_TRUE(std::equal(order.begin(), order.end(), expected.begin(), expected.end())) << n;
  }
}

TEST(ProjectionSorter, TellsSharpLobesApartAboutTheirCentre) {
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(0.9 + 1e-12 * ((i * 37) % 1000));
  ProjectionSorter sorter;
  const std::span<const std::uint32_t> order = sorter.order(values, 0.9);
  for (std::size_t i = 1; i < order.size(); ++i) EXPECT_LT(values[order[i - 1]], values[order[i]]);
}

}  // namespace
}  // namespace ltcfit
