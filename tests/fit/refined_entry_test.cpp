#include "fit/refined_entry.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "ggx/random.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;

constexpr MatrixFamily kFamilies[] = {MatrixFamily::kGeneral, MatrixFamily::kMirrorY, MatrixFamily::kMirrorX,
                                      MatrixFamily::kMirrorXY, MatrixFamily::kRotational};
const StoredForm kForms[] = {{MatrixStorage::kM, MatrixNormalization::kNone},
                             {MatrixStorage::kM, MatrixNormalization::kThirdColumnUnit},
                             {MatrixStorage::kMinv, MatrixNormalization::kMiddleElement}};

// A wide lobe and a needle; what tables store inverted is isotropic, so mirrored by x-z at least.
std::vector<Matrix3d> matricesOf(MatrixFamily family) {
  Matrix3d wide;
  wide << 0.7, 0.1, 0.6, -0.05, 0.4, 0.3, -0.3, 0.1, 0.8;
  Matrix3d needle;
  needle << 2e-4, 3e-5, 0.9, -1e-5, 1e-4, 0.1, -1e-4, 2e-5, 0.4;
  return {projectOnFamily(wide, family), projectOnFamily(needle, family)};
}

bool isStored(MatrixFamily family, const StoredForm& form) {
  return form.stores == MatrixStorage::kM ||
         (family != MatrixFamily::kGeneral && family != MatrixFamily::kMirrorX);
}

template <class Check>
void forAll(const Check& check) {
  for (const MatrixFamily family : kFamilies) {
    for (const StoredForm& form : kForms) {
      if (!isStored(family, form)) continue;
      for (const Matrix3d& m : matricesOf(family)) {
        SCOPED_TRACE(testing::Message()
                     << "family " << static_cast<int>(family) << ", stores " << matrixStorageName(form.stores)
                     << ", " << matrixNormalizationName(form.normalization) << ", m00 " << m(0, 0));
        check(m, family, form);
      }
    }
  }
}

// Parameters of a size; 10 is far beyond what a refinement does.
void setRandom(double size, Random& random, RefinedEntry* entry) {
  for (double& p : entry->parameters()) p = size * (2.0 * random.uniform() - 1.0);
  entry->update();
}

TEST(RefinedEntry, ParametersOfZeroGiveTheMatrixBack) {
  forAll([](const Matrix3d& m, MatrixFamily family, const StoredForm& form) {
    const RefinedEntry entry(m, family, form);
    EXPECT_EQ(entry.family(), family);
    for (const double p : entry.parameters()) EXPECT_EQ(p, 0.0);
    const Matrix3d raw = form.stores == MatrixStorage::kM ? m : Matrix3d(m.inverse());
    // one division by a length that may itself be rounded
    EXPECT_LT((entry.stored() - normalized(raw, form.normalization)).norm(), 1e-15 * entry.stored().norm());
  });
}

TEST(RefinedEntry, HasTheFreedomOfItsFamily) {
  const std::size_t expected[] = {8, 4, 4, 2, 1};
  for (const MatrixFamily family : kFamilies) {
    const Matrix3d m = matricesOf(family)[0];
    const std::size_t n = expected[static_cast<std::size_t>(family)];
    EXPECT_EQ(RefinedEntry(m, family, kForms[1]).size(), n);
    EXPECT_EQ(RefinedEntry(m, family, kForms[0]).size(), n + 1) << "the scale";
  }
}

TEST(RefinedEntry, DerivativesAgreeWithDifferencesAndWrongOnesDoNot) {
  forAll([](const Matrix3d& m, MatrixFamily family, const StoredForm& form) {
    Random random(3);
    RefinedEntry entry(m, family, form);
    for (const double size : {0.0, 0.5, 10.0}) {
      setRandom(size, random, &entry);
      for (std::size_t k = 0; k < entry.size(); ++k) {
        const Matrix3d analytic = entry.derivative(k);
        const double at = entry.parameters()[k];
        const double h = 1e-3 * std::max(1.0, std::abs(at));
        const auto storedAt = [&](double p) {
          entry.parameters()[k] = p;
          entry.update();
          return entry.stored();
        };
        // fourth order
        const Matrix3d difference = (8.0 * (storedAt(at + h) - storedAt(at - h)) -
                                     (storedAt(at + 2.0 * h) - storedAt(at - 2.0 * h))) /
                                    (12.0 * h);
        storedAt(at);
        // rounding of stored over the step; the inverse of a needle is rounded by its condition
        const double rounding = form.stores == MatrixStorage::kM ? 1e-10 : 1e-7;
        const double tolerance = 1e-6 * analytic.norm() + rounding * entry.stored().norm();
        EXPECT_LT((difference - analytic).norm(), tolerance) << "parameter " << k << " at " << at;
        if (analytic.norm() > 1e3 * rounding * entry.stored().norm()) {
          EXPECT_GT((difference - 1.01 * analytic).norm(), tolerance) << "a derivative that is 1 % off";
        }
      }
    }
  });
}

TEST(RefinedEntry, KeepsDeterminantAndSymmetryWhateverTheParameters) {
  forAll([](const Matrix3d& m, MatrixFamily family, const StoredForm& form) {
    Random random(4);
    RefinedEntry entry(m, family, form);
    for (const double size : {0.1, 1.0, 10.0}) {
      for (int i = 0; i < 50; ++i) {
        setRandom(size, random, &entry);
        EXPECT_GT(entry.stored().determinant(), 0.0);
        EXPECT_TRUE(entry.stored().allFinite());
        EXPECT_EQ(projectOnFamily(entry.stored(), family), entry.stored()) << "exact zeros";
        for (std::size_t k = 0; k < entry.size(); ++k)
          EXPECT_EQ(projectOnFamily(entry.derivative(k), family), entry.derivative(k));
        if (form.normalization == MatrixNormalization::kThirdColumnUnit) {
          EXPECT_NEAR(entry.stored().col(2).norm(), 1.0, 1e-15);
        }
        if (form.normalization == MatrixNormalization::kMiddleElement) {
          EXPECT_EQ(entry.stored()(1, 1), 1.0);
        }
      }
    }
  });
}

TEST(RefinedEntry, ReachesAnyMatrixOfItsFamilyThatIsNear) {
  // Gauss-Newton's steps towards a planted matrix: the parameters span the family
  forAll([](const Matrix3d& m, MatrixFamily family, const StoredForm& form) {
    RefinedEntry planted(m, family, form);
    Random random(6);
    setRandom(0.2, random, &planted);
    const Matrix3d goal = planted.stored();
    RefinedEntry entry(m, family, form);
    const auto n = static_cast<Eigen::Index>(entry.size());
    // entries of needles differ by 1e4
    const Matrix3d weight = goal.cwiseAbs().cwiseMax(1e-12).cwiseInverse();
    for (int step = 0; step < 30; ++step) {
      Eigen::MatrixXd j(9, n);
      for (Eigen::Index k = 0; k < n; ++k) {
        const Matrix3d d = entry.derivative(static_cast<std::size_t>(k)).cwiseProduct(weight);
        j.col(k) = d.reshaped();
      }
      const Matrix3d missing = (goal - entry.stored()).cwiseProduct(weight);
      const Eigen::VectorXd change = j.colPivHouseholderQr().solve(Eigen::VectorXd(missing.reshaped()));
      for (Eigen::Index k = 0; k < n; ++k) entry.parameters()[static_cast<std::size_t>(k)] += change[k];
      entry.update();
    }
    EXPECT_LT((entry.stored() - goal).norm(), 1e-9 * goal.norm());
  });
}

}  // namespace
}  // namespace ltcfit
