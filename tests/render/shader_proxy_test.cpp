// Proxy spheres and the tests before the look-up of the shader snippets, against the same in double.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "ltc/polygon.h"
#include "ltc/sphere.h"
#include "tests/render/tables.h"

namespace ltcfit::test {
namespace {

using Eigen::Vector3d;
using Quad = std::array<Vec3, 4>;

constexpr Mat3 kIdentity{{{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}}};

class ShaderProxy : public testing::TestWithParam<Shader> {
 protected:
  const Shader& shader() const { return GetParam(); }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vector3d direction() {
    std::normal_distribution<double> normal;
    const double x = normal(random_);
    const double y = normal(random_);
    return Vector3d(x, y, normal(random_)).normalized();
  }
  Quad quad() {
    const Vector3d c = direction() * uniform(0.3, 3.0);
    const Vector3d a = direction() * uniform(0.05, 1.0);
    const Vector3d b = direction() * uniform(0.05, 1.0);
    return {toVec3(c - a - b), toVec3(c + a - b), toVec3(c + a + b), toVec3(c - a + b)};
  }
  Mat3 inverse(int i) {
    if (i % 2 == 0) return kIdentity;
    return {{{static_cast<float>(uniform(0.5, 2.0)), 0.0f, static_cast<float>(uniform(-0.5, 0.5))},
             {0.0f, 1.0f, 0.0f},
             {static_cast<float>(uniform(-0.5, 0.5)), 0.0f, static_cast<float>(uniform(0.5, 2.0))}}};
  }

 private:
  std::mt19937 random_{1};
};
INSTANTIATE_TEST_SUITE_P(Languages, ShaderProxy, testing::Values(kGlsl, kHlsl),
                         [](const auto& instance) { return instance.param.name; });

std::vector<Vector3d> toVectors(const Quad& q) {
  std::vector<Vector3d> v;
  for (const Vec3& p : q) v.push_back(toEigen(p));
  return v;
}

Quad backwards(const Quad& q) {
  return {q[3], q[2], q[1], q[0]};
}

Texture sphereTexture() {
  Texture texture{64, 64, 1, {}, 0};
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double value = sphereTableValue(2.0 * x / 63.0 - 1.0, y / 63.0);
      texture.texels.push_back({-1.0f, -1.0f, -1.0f, static_cast<float>(value)});
    }
  }
  return texture;
}

TEST_P(ShaderProxy, VectorFormFactorAgrees) {
  double worst = 0.0;
  double worstAbove = 0.0;
  int above = 0;
  for (int i = 0; i < 20000; ++i) {
    const Mat3 inv = inverse(i);
    const Quad q = quad();
    std::vector<Vector3d> moved = toVectors(q);
    bool all = true;
    for (Vector3d& v : moved) {
      v = toEigen(inv) * v;
      all = all && v.z() > 1e-3;
    }
    const Vec3 is = shader().formFactor(inv, q);
    raise(worst, (toEigen(is) - vectorFormFactor(moved)).norm());
    if (!all) continue;
    ++above;
    raise(worstAbove, static_cast<double>(std::abs(is[2] - shader().quad(inv, q))));
  }
  // roundings of vertices, 6e-8, grow towards edges that pass the point
  EXPECT_LT(worst, 2e-5);
  // the same edges, of the same directions
  EXPECT_LT(worstAbove, 2e-6);
  EXPECT_GT(above, 1000);
}

TEST_P(ShaderProxy, SpheresAgree) {
  const Texture texture = sphereTexture();
  const SphereTable table;
  double worst = 0.0;
  double worstByTable = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d f = direction() * uniform(0.0, 1.0);
    raise(worst, std::abs(static_cast<double>(shader().proxySphere(toVec3(f))) - proxySphereFormFactor(f)));
    raise(worstByTable, std::abs(static_cast<double>(shader().proxySphereTable(texture, toVec3(f))) -
                                 f.norm() * table(f.z() / f.norm(), f.norm())));
  }
  // a few roundings of values up to 1; texture coordinates of 1e-7 by 63 texels and slopes up to 2 a unit
  EXPECT_LT(worst, 3e-7);
  EXPECT_LT(worstByTable, 1e-5);
}

TEST_P(ShaderProxy, WholePathsAgree) {
  const Texture texture = sphereTexture();
  const SphereTable table;
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Mat3 inv = inverse(i);
    Quad q = quad();
    if (!shader().facing(q[0], q[1], q[2])) q = backwards(q);
    const Ltc ltc(toEigen(inv).inverse());
    const Vec3 f = shader().formFactor(inv, q);
    raise(worst, std::abs(static_cast<double>(shader().proxySphere(f)) -
                          ltcPolygonIntegralByProxySphere(ltc, toVectors(q))));
    raise(worst, std::abs(static_cast<double>(shader().proxySphereTable(texture, f)) -
                          ltcPolygonIntegralBySphereTable(ltc, toVectors(q), table)));
  }
  EXPECT_LT(worst, 5e-5);  // the two above, one after the other
}

TEST_P(ShaderProxy, NoVectorIsNoLight) {
  const Texture texture = sphereTexture();
  EXPECT_EQ(shader().proxySphere({0.0f, 0.0f, 0.0f}), 0.0f);
  EXPECT_EQ(shader().proxySphereTable(texture, {0.0f, 0.0f, 0.0f}), 0.0f);
  for (float tiny : {1e-45f, 1e-38f, 1e-20f}) {
    EXPECT_NEAR(shader().proxySphere({tiny, tiny, tiny}), 0.0f, 1e-19f);
    EXPECT_NEAR(shader().proxySphereTable(texture, {-tiny, tiny, -tiny}), 0.0f, 1e-19f);
  }
  const Vec3 origin{0.0f, 0.0f, 0.0f};
  EXPECT_EQ(shader().formFactor(kIdentity, {origin, origin, origin, origin}), origin);
}

TEST_P(ShaderProxy, FacingIsTheSignOfTheIntegral) {
  int positive = 0;
  int negative = 0;
  for (int i = 0; i < 20000; ++i) {
    const Mat3 inv = inverse(i);
    const Quad q = quad();
    const float value = shader().quad(inv, q);
    // nearer to zero the roundings decide
    if (std::abs(value) < 1e-5f) continue;
    const bool facing = shader().facing(q[0], q[1], q[2]);
    EXPECT_EQ(facing, value > 0.0f) << i << ' ' << value;
    const Quad turned = backwards(q);
    EXPECT_NE(facing, shader().facing(turned[0], turned[1], turned[2]));
    ++(facing ? positive : negative);
  }
  EXPECT_GT(positive, 3000);
  EXPECT_GT(negative, 3000);
}

// Overhead and in front, once clockwise as the shaded point sees them, once the other way.
TEST_P(ShaderProxy, LightsTowardsThePointRunClockwise) {
  const Quad overhead{Vec3{1.0f, 1.0f, 1.0f}, Vec3{-1.0f, 1.0f, 1.0f}, Vec3{-1.0f, -1.0f, 1.0f},
                      Vec3{1.0f, -1.0f, 1.0f}};
  // looking along x, z is up and y to the left: from top left to top right, and down
  const Quad inFront{Vec3{2.0f, 1.0f, 2.0f}, Vec3{2.0f, -1.0f, 2.0f}, Vec3{2.0f, -1.0f, 1.0f},
                     Vec3{2.0f, 1.0f, 1.0f}};
  for (const Quad& clockwise : {overhead, inFront}) {
    const Vector3d centre = 0.25 * (toEigen(clockwise[0]) + toEigen(clockwise[1]) + toEigen(clockwise[2]) +
                                    toEigen(clockwise[3]));
    for (const bool turned : {false, true}) {
      const Quad q = turned ? backwards(clockwise) : clockwise;
      EXPECT_NE(shader().facing(q[0], q[1], q[2]), turned);
      EXPECT_NE(shader().quad(kIdentity, q) > 0.0f, turned);
      EXPECT_NE(toEigen(shader().formFactor(kIdentity, q)).dot(centre) > 0.0, turned);
    }
  }
}

// What ltcAboveSurface says of the step: a wall that sets behind the horizon, opposite of the view.
TEST_P(ShaderProxy, SkippingLeavesAStep) {
  const IsotropicTextures textures = isotropicTextures(isotropicTable());
  const Quad wall{Vec3{-1.0f, -1e3f, 0.0f}, Vec3{-1.0f, 1e3f, 0.0f}, Vec3{-1.0f, 1e3f, -1e3f},
                  Vec3{-1.0f, -1e3f, -1e3f}};
  ASSERT_TRUE(shader().facing(wall[0], wall[1], wall[2]));
  ASSERT_FALSE(shader().aboveSurface(wall));
  const auto step = [&](double degrees, double roughness) {
    const auto nDotV = static_cast<float>(std::cos(degrees * 3.14159265358979 / 180.0));
    const ShaderEntry entry =
        shader().fetch(textures.matrix, textures.amplitude, static_cast<float>(roughness), nDotV);
    return static_cast<double>(entry.norm * shader().quad(entry.inverse, wall));
  };
  const auto largest = [&](double degrees) {
    double most = 0.0;
    for (int i = 0; i <= 100; ++i) most = std::max(most, step(degrees, i / 100.0));
    return most;
  };
  // the comment rounds to 0.01, and another table may differ a little
  EXPECT_NEAR(largest(90.0), 0.21, 0.005);
  EXPECT_NEAR(largest(89.0), 0.08, 0.005);
  EXPECT_NEAR(largest(85.0), 0.036, 0.005);
  EXPECT_NEAR(step(89.0, 0.2), 0.07, 0.005);
  EXPECT_NEAR(step(85.0, 0.2), 0.03, 0.005);
}

TEST_P(ShaderProxy, AboveSurfaceIsWhatTheCosineSees) {
  int above = 0;
  for (int i = 0; i < 20000; ++i) {
    const Quad q = quad();
    if (shader().aboveSurface(q)) {
      ++above;
      continue;
    }
    EXPECT_EQ(shader().quad(kIdentity, q), 0.0f);
  }
  EXPECT_GT(above, 5000);
  EXPECT_LT(above, 15000);
  // a vertex on the surface is not above it, one just over it is
  const Quad flat{Vec3{1.0f, 0.0f, 0.0f}, Vec3{2.0f, 0.0f, 0.0f}, Vec3{2.0f, 1.0f, 0.0f},
                  Vec3{1.0f, 1.0f, -1.0f}};
  EXPECT_FALSE(shader().aboveSurface(flat));
  for (std::size_t k = 0; k < 4; ++k) {
    Quad raised = flat;
    raised[k][2] = 1e-6f;
    EXPECT_TRUE(shader().aboveSurface(raised)) << k;
  }
}

}  // namespace
}  // namespace ltcfit::test
