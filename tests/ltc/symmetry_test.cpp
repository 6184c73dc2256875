#include "ltc/symmetry.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "ggx/ggx_lobe.h"
#include "ggx/random.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;

TEST(CanonicalLobe, IsTheSameLobeMirrored) {
  Random random(1);
  for (int i = 0; i < 400; ++i) {
    const LobeParameters p{0.02 + 0.9 * random.uniform(), 0.02 + 0.9 * random.uniform(),
                           1.5 * random.uniform(), 12.0 * random.uniform() - 6.0};
    const CanonicalLobe c = canonicalLobe(p);
    EXPECT_GE(c.parameters.alphaX, c.parameters.alphaY);
    EXPECT_GE(c.parameters.phi, 0.0);
    EXPECT_LE(c.parameters.phi, 0.5 * kPi);
    EXPECT_NEAR((c.map * c.map.transpose() - Matrix3d::Identity()).norm(), 0.0, 1e-15);
    const GgxLobe asked(viewDirection(p.theta, p.phi), {p.alphaX, p.alphaY});
    const GgxLobe stored(viewDirection(c.parameters.theta, c.parameters.phi),
                         {c.parameters.alphaX, c.parameters.alphaY});
    for (int k = 0; k < 5; ++k) {
      const Vector3d w = Vector3d(random.normal(), random.normal(), 0.1 + random.uniform()).normalized();
      EXPECT_NEAR(asked.eval(c.map * w), stored.eval(w), 1e-9 * (1.0 + stored.eval(w))) << p.phi;
    }
  }
}

TEST(CanonicalLobe, QuadrantsOfEquation13) {
  const auto signs = [](double phi) {
    const Matrix3d m = canonicalLobe({0.5, 0.2, 1.0, phi}).map;
    return std::pair(m(0, 0), m(1, 1));
  };
  EXPECT_EQ(signs(0.3), std::pair(1.0, 1.0));
  EXPECT_EQ(signs(kPi - 0.3), std::pair(-1.0, 1.0));
  EXPECT_EQ(signs(kPi + 0.3), std::pair(-1.0, -1.0));
  EXPECT_EQ(signs(2.0 * kPi - 0.3), std::pair(1.0, -1.0));
  for (double phi : {0.3, kPi - 0.3, kPi + 0.3, -0.3, 2.0 * kPi + 0.3})
    EXPECT_NEAR(canonicalLobe({0.5, 0.2, 1.0, phi}).parameters.phi, 0.3, 1e-15) << phi;
  // eq. 15
  const CanonicalLobe swapped = canonicalLobe({0.2, 0.5, 1.0, 0.3});
  EXPECT_EQ(swapped.parameters.alphaX, 0.5);
  EXPECT_NEAR(swapped.parameters.phi, 0.5 * kPi - 0.3, 1e-15);
}

TEST(FromCanonical, KeepsTheDeterminant) {
  Matrix3d t;
  t << 0.5, 0.1, -0.3, 0.05, 0.2, -0.4, 0.1, 0.2, 0.8;
  for (double phi : {0.3, 2.0, 4.0, 5.0}) {
    for (double alphaY : {0.1, 0.9})
      EXPECT_NEAR(fromCanonical(canonicalLobe({0.5, alphaY, 1.0, phi}), t).determinant(), t.determinant(),
                  1e-15);
  }
}

}  // namespace
}  // namespace ltcfit
