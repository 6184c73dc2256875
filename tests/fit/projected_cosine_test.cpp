#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <memory>

#include "fit/moment_start.h"
#include "fit/projected_cdf_loss.h"
#include "ggx/ggx_lobe.h"
#include "ggx/random.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

struct Case {
  double alphaX, alphaY, theta, phi;
};
// wide and narrow, symmetric and not, grazing view
const std::vector<Case> kCases{{1, 1, 0, 0},           {0.5, 0.2, 0.8, 0.5},
                               {0.3, 0.01, 1.0, 0.7},  {0.01, 0.01, 1.4, 0},
                               {1e-4, 1e-4, 1.57, 0},  {1, 1e-4, 1.2, 0.35},
                               {0.1, 0.01, 1.54, 1.0}, {0.2, 0.1, 0.5 * 3.14159265358979, 0.3}};

Matrix3d nine(const Vector9d& v) {
  Matrix3d m;
  for (Eigen::Index k = 0; k < 9; ++k) m(k / 3, k % 3) = v[k];
  return m;
}

Vector9d rows(const Matrix3d& m) {
  Vector9d v;
  for (Eigen::Index k = 0; k < 9; ++k) v[k] = m(k / 3, k % 3);
  return v;
}

Vector9d randomDirection(Random& random) {
  Vector9d v;
  for (Eigen::Index k = 0; k < 9; ++k) v[k] = random.normal();
  return v.normalized();
}

struct Problem {
  explicit Problem(const Case& c) {
    const GgxLobe lobe(viewDirection(c.theta, c.phi), {c.alphaX, c.alphaY});
    const LobeSamples target = weightedSamples(lobe, 2048, 1);
    start = momentStart(target);
    projected = std::make_unique<ProjectedLobe>(target, start, familySlices(MatrixFamily::kGeneral, 24));
  }
  Matrix3d start;
  std::unique_ptr<ProjectedLobe> projected;
};

// At the start, off it, far from it.
std::vector<Matrix3d> placesOf(const Matrix3d& start) {
  Matrix3d off = Matrix3d::Identity();
  off(0, 2) = 0.4;
  off(1, 0) = -0.2;
  off(1, 1) = 1.3;
  Matrix3d far = start;
  far.col(2) += start.col(2).norm() * Vector3d(0.3, -0.2, 0.1);
  return {start, start * off, 7.0 * far, Matrix3d::Identity()};
}

TEST(ProjectedCosine, DerivativesComeWithTheValueAndGradientOfThePlainCall) {
  ProjectedCosine cosine(cosineSamples(512, 7));
  for (const Case& c : kCases) {
    const Problem p(c);
    for (const Matrix3d& m : placesOf(p.start)) {
      Matrix3d plain;
      const double value = cosine.loss(*p.projected, m, &plain);
      EXPECT_EQ(cosine.loss(*p.projected, m, static_cast<Matrix3d*>(nullptr)), value);
      ProjectedCosine::Derivatives d;
      EXPECT_EQ(cosine.loss(*p.projected, m, &d), value);
      const Vector9d expected = rows(m.transpose() * plain);
      // the same sums, multiplied in another order
      EXPECT_LT((d.gradient - expected).norm(), 1e-12 * expected.norm()) << c.alphaX << " " << c.theta;
      EXPECT_GT((d.gradient - rows(plain.transpose() * m)).norm(), 1e-3 * expected.norm()) << "transposed";
    }
  }
}

double lossAt(ProjectedCosine& cosine, const Problem& p, const Matrix3d& m) {
  return cosine.loss(*p.projected, m, static_cast<Matrix3d*>(nullptr));
}

TEST(ProjectedCosine, CurvatureIsSemidefiniteAndBoundsTheGradient) {
  ProjectedCosine cosine(cosineSamples(512, 7));
  for (const Case& c : kCases) {
    const Problem p(c);
    for (const Matrix3d& m : placesOf(p.start)) {
      ProjectedCosine::Derivatives d;
      const double value = cosine.loss(*p.projected, m, &d);
      EXPECT_EQ((d.curvature - d.curvature.transpose()).norm(), 0.0);
      const double trace = d.curvature.trace();
      EXPECT_GT(trace, 0.0);
      const Eigen::SelfAdjointEigenSolver<Matrix9d> eigen(d.curvature);
      EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-12 * trace);
      // as the refinement regularises it; 1.2 is the most that was seen
      const Matrix9d regular = d.curvature + 1e-9 * trace * Matrix9d::Identity();
      EXPECT_LT(d.gradient.dot(regular.llt().solve(d.gradient)), 1.5 * value) << c.alphaX << " " << c.theta;
    }
  }
}

TEST(ProjectedCosine, ScaleAndRotationAboutZAreFree) {
  ProjectedCosine few(cosineSamples(512, 7));
  ProjectedCosine many(cosineSamples(8192, 7));
  const Vector9d scale = rows(Matrix3d::Identity()).normalized();
  Vector9d rotation = Vector9d::Zero();
  rotation[1] = std::sqrt(0.5);
  rotation[3] = -rotation[1];
  for (const Case& c : kCases) {
    const Problem p(c);
    const Matrix3d m = placesOf(p.start)[1];
    ProjectedCosine::Derivatives d;
    few.loss(*p.projected, m, &d);
    const double trace = d.curvature.trace();
    EXPECT_LT(scale.dot(d.curvature * scale), 1e-12 * trace);
    EXPECT_LT(std::abs(d.gradient.dot(scale)), 1e-6 * d.gradient.norm()) << "float positions";
    // samples that a rotation takes to where others were: free as far as their spacing does not show
    const double turned = rotation.dot(d.curvature * rotation) / trace;
    EXPECT_LT(turned, 0.05);
    EXPECT_LT(std::abs(d.gradient.dot(rotation)), 0.02 * d.gradient.norm());
    many.loss(*p.projected, m, &d);
    EXPECT_LT(rotation.dot(d.curvature * rotation) / d.curvature.trace(), 0.5 * turned);
  }
}

TEST(ProjectedCosine, QuadraticLiesAboveTheLoss) {
  ProjectedCosine cosine(cosineSamples(512, 7));
  // of the loss: what cells whose CDFs all but agree may lose, and the CDFs' own curvature
  constexpr double kTolerance = 1e-3;
  double largestWithout = 0.0;
  for (const Case& c : kCases) {
    const Problem p(c);
    for (const Matrix3d& m : placesOf(p.start)) {
      ProjectedCosine::Derivatives d;
      const double value = cosine.loss(*p.projected, m, &d);
      Random random(5);
      for (int i = 0; i < 40; ++i) {
        const Vector9d v = 0.01 * randomDirection(random);
        const double at = lossAt(cosine, p, m * (Matrix3d::Identity() + nine(v)));
        const double line = value + d.gradient.dot(v);
        EXPECT_LT(at, line + 0.5 * v.dot(d.curvature * v) + kTolerance * value) << c.alphaX << " " << c.theta;
        largestWithout = std::max(largestWithout, (at - line) / value);
      }
    }
  }
  EXPECT_GT(largestWithout, 5.0 * kTolerance) << "a line would do as well";
}

TEST(ProjectedCosine, ServesManyLobesAsOneEachWould) {
  const LobeSamples samples = cosineSamples(300, 2);
  ProjectedCosine shared(samples);
  for (int round = 0; round < 2; ++round) {
    for (const Case& c : kCases) {
      const Problem p(c);
      for (const Matrix3d& m : placesOf(p.start)) {
        ProjectedCosine own(samples);
        ProjectedCosine::Derivatives a;
        ProjectedCosine::Derivatives b;
        EXPECT_EQ(shared.loss(*p.projected, m, &a), own.loss(*p.projected, m, &b));
        EXPECT_EQ(a.gradient, b.gradient);
        EXPECT_EQ(a.curvature, b.curvature);
        EXPECT_EQ(lossAt(shared, p, m), lossAt(own, p, m));
      }
    }
  }
}

}  // namespace
}  // namespace ltcfit
