#include "fit/projected_cdf_loss.h"

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "fit/moment_start.h"
#include "ggx/ggx_lobe.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The same area by sorting both sets of weighted samples, in double.
double areaBySorting(const LobeSamples& target, const Matrix3d& m, const LobeSamples& cosine,
                     const std::vector<Vector3d>& slices) {
  double sum = 0.0;
  for (const Vector3d& w : slices) {
    std::vector<std::pair<double, double>> steps;
    for (std::size_t i = 0; i < target.directions.size(); ++i)
      steps.emplace_back(w.dot(target.directions[i]), target.weights[i]);
    for (std::size_t i = 0; i < cosine.directions.size(); ++i)
      steps.emplace_back(w.dot((m * cosine.directions[i]).normalized()), -cosine.weights[i]);
    std::sort(steps.begin(), steps.end());
    double difference = 0.0;
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
      difference += steps[i].second;
      sum += std::abs(difference) * (steps[i + 1].first - steps[i].first);
    }
  }
  return sum / static_cast<double>(slices.size());
}

struct Case {
  double alphaX, alphaY, theta, phi;
};
const std::vector<Case> kCases{{1, 1, 0, 0},           {0.5, 0.2, 0.8, 0.5},  {0.3, 0.01, 1.0, 0.7},
                               {0.01, 0.01, 1.4, 0},   {1e-4, 1e-4, 1.57, 0}, {1, 1e-4, 1.2, 0.35},
                               {0.1, 0.01, 1.54, 1.0}, {0.8, 0.4, 0.35, 1.2}};

struct Problem {
  explicit Problem(const Case& c)
      : lobe(viewDirection(c.theta, c.phi), {c.alphaX, c.alphaY}),
        target(weightedSamples(lobe, 8192, 1)),
        cosine(cosineSamples(2048, 7)),
        slices(familySlices(MatrixFamily::kGeneral, 64)),
        start(momentStart(target)),
        loss(target, start, cosine, slices) {}
  GgxLobe lobe;
  LobeSamples target;
  LobeSamples cosine;
  std::vector<Vector3d> slices;
  Matrix3d start;
  ProjectedCdfLoss loss;
};

TEST(ProjectedCdfLoss, IsTheAreaBetweenTheCdfs) {
  for (const Case& c : kCases) {
    Problem p(c);
    Matrix3d far = p.start;
    far.col(2) += Vector3d(0.3, -0.2, 0.1);
    for (const Matrix3d& m : {p.start, far, Matrix3d(Matrix3d::Identity())}) {
      const double exact = areaBySorting(p.target, m, p.cosine, p.slices);
      // cells are a sixteenth of an octave: where the CDFs cross within one a little area is lost, 0.5 % of
      // the small loss that is left at the start for alpha = 1
      EXPECT_NEAR(p.loss(m, nullptr) / exact, 1.0, 1e-2) << c.alphaX << " " << c.theta;
    }
    EXPECT_NEAR(p.loss(5.0 * p.start, nullptr), p.loss(p.start, nullptr), 1e-9) << "scale";
  }
}

TEST(ProjectedCdfLoss, GradientAgreesWithDifferencesAndAWrongOneDoesNot) {
  for (const Case& c : kCases) {
    Problem p(c);
    // off the optimum, where slices see a shift and not only noise
    const Matrix3d m = p.start * (Matrix3d::Identity() + 0.2 * familyBasis(MatrixFamily::kGeneral)[3] +
                                  0.1 * familyBasis(MatrixFamily::kGeneral)[0]);
    Matrix3d gradient;
    p.loss(m, &gradient);
    double error = 0.0;
    double wrong = 0.0;
    double length = 0.0;
    for (const Matrix3d& b : familyBasis(MatrixFamily::kGeneral)) {
      const double h = 3e-5;
      const double difference = (p.loss(m * (Matrix3d::Identity() + h * b), nullptr) -
                                 p.loss(m * (Matrix3d::Identity() - h * b), nullptr)) /
                                (2.0 * h);
      const double analytic = (m.transpose() * gradient).cwiseProduct(b).sum();
      error = std::max(error, std::abs(difference - analytic));
      wrong = std::max(wrong,
                       std::abs(difference - (m.transpose() * gradient.transpose()).cwiseProduct(b).sum()));
      length = std::max(length, std::abs(analytic));
    }
    // kinks of |F - G| that the step of the difference crosses
    EXPECT_LT(error, 1e-2 * length) << c.alphaX << " " << c.alphaY << " " << c.theta;
    EXPECT_GT(wrong, 2e-2 * length) << "the transposed gradient";
    // scale and rotation about z change nothing
    EXPECT_NEAR((m.transpose() * gradient).trace(), 0.0, 1e-3 * length);
    const Matrix3d turned = m.transpose() * gradient;
    EXPECT_NEAR(turned(0, 1) - turned(1, 0), 0.0, 3e-2 * length);
  }
}

class LossCost final : public ceres::CostFunction {
 public:
  LossCost(Problem& problem, double factor) : problem_(problem), factor_(factor) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(7);
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Matrix3d m = changedBy(problem_.start, MatrixFamily::kGeneral, {parameters[0], 7});
    Matrix3d gradient;
    residuals[0] = problem_.loss(m, &gradient);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      const Matrix3d relative = problem_.start.transpose() * gradient;
      for (std::size_t k = 0; k < 7; ++k)
        jacobians[0][k] = relative.cwiseProduct(familyBasis(MatrixFamily::kGeneral)[k]).sum();
      jacobians[0][0] *= factor_;
    }
    return true;
  }

 private:
  Problem& problem_;
  double factor_;
};

TEST(ProjectedCdfLoss, PassesCeresGradientChecker) {
  Problem p({0.5, 0.2, 0.8, 0.5});
  const std::array<double, 7> at{0.1, 0.05, 0.1, 0.2, -0.1, 0.1, 0.05};
  const double* const parameters[] = {at.data()};
  ceres::NumericDiffOptions options;
  // short enough to cross few kinks of |F - G|, long enough for the float32 positions
  options.ridders_relative_initial_step_size = 3e-4;
  options.max_num_ridders_extrapolations = 1;
  for (const double factor : {1.0, 1.2}) {
    LossCost cost(p, factor);
    const ceres::GradientChecker checker(
        &cost, static_cast<const std::vector<const ceres::Manifold*>*>(nullptr), options);
    ceres::GradientChecker::ProbeResults results;
    EXPECT_EQ(checker.Probe(parameters, 3e-2, &results), factor == 1.0) << results.error_log;
  }
}

TEST(ProjectedCdfLoss, ResolvesLobesBelowAFloatsDigits) {
  // the same problem at a ten-thousandth of the width has a ten-thousandth of the loss
  const LobeSamples cosine = cosineSamples(1024, 3);
  const std::vector<Vector3d> slices = familySlices(MatrixFamily::kGeneral, 32);
  double wide = 0.0;
  for (const double width : {1e-3, 1e-7}) {
    Matrix3d m = Eigen::AngleAxisd(1.0, Vector3d(1, 2, 0.5).normalized()).toRotationMatrix();
    m.leftCols<2>() *= width;
    LobeSamples target = cosineSamples(4096, 4);
    Matrix3d planted = m;
    planted.col(0) *= 1.3;
    for (Vector3d& d : target.directions) d = (planted * d).normalized();
    ProjectedCdfLoss loss(target, m, cosine, slices);
    if (width == 1e-3) {
      wide = loss(m, nullptr) / width;
    } else {
      EXPECT_NEAR(loss(m, nullptr) / width / wide, 1.0, 0.02);
    }
  }
}

TEST(FamilySlices, AreUnitVectorsOfTheReducedDomain) {
  for (const auto family : {MatrixFamily::kGeneral, MatrixFamily::kMirrorY, MatrixFamily::kMirrorX,
                            MatrixFamily::kMirrorXY, MatrixFamily::kRotational}) {
    for (const Vector3d& w : familySlices(family, 100)) {
      EXPECT_NEAR(w.norm(), 1.0, 1e-14);
      EXPECT_GE(w.z(), 0.0);
      if (family == MatrixFamily::kMirrorY) {
        EXPECT_GE(w.y(), -1e-15);
      }
      if (family == MatrixFamily::kMirrorX) {
        EXPECT_GE(w.x(), -1e-15);
      }
      if (family == MatrixFamily::kMirrorXY) {
        EXPECT_GE(std::min(w.x(), w.y()), -1e-15);
      }
    }
  }
}

}  // namespace
}  // namespace ltcfit
