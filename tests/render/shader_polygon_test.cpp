// The polygon integral of the shader snippets against ltcPolygonIntegral in double.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "ltc/polygon.h"
#include "tests/render/tables.h"

namespace ltcfit::test {
namespace {

using Eigen::Vector3d;
using Quad = std::array<Vec3, 4>;

constexpr Mat3 kIdentity{{{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}}};

class ShaderPolygon : public testing::TestWithParam<Shader> {
 protected:
  ShaderPolygon() : texture_(anisotropicTexture(anisotropicTable())) {}

  const Shader& shader() const { return GetParam(); }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double logUniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  Vector3d direction() {
    std::normal_distribution<double> normal;
    const double x = normal(random_);
    const double y = normal(random_);
    return Vector3d(x, y, normal(random_)).normalized();
  }
  Vec3 view() {
    Vector3d v = direction();
    v.z() = std::abs(v.z());
    return toVec3(v);
  }
  // The clamped cosine itself, and lobes from broad to the floor.
  Mat3 inverse(int i) {
    if (i % 4 == 0) return kIdentity;
    const auto alpha = [&] { return static_cast<float>(logUniform(1e-4, 1.0)); };
    const float alphaX = alpha();
    return shader().fetchAnisotropic(texture_, 8, 8, alphaX, alpha(), view()).inverse;
  }
  // Parallelogram anywhere around the point; half of them cross the horizon or are below it.
  Quad quad(double size, double ratio) {
    const Vector3d c = direction() * logUniform(0.1, 10.0);
    const Vector3d a = direction() * size * c.norm();
    const Vector3d b = direction() * size * ratio * c.norm();
    return {toVec3(c - a - b), toVec3(c + a - b), toVec3(c + a + b), toVec3(c - a + b)};
  }

 private:
  Texture texture_;
  std::mt19937 random_{1};
};
INSTANTIATE_TEST_SUITE_P(Languages, ShaderPolygon, testing::Values(kGlsl, kHlsl),
                         [](const auto& instance) { return instance.param.name; });

template <class Vertices>
double expected(const Mat3& inverse, const Vertices& vertices) {
  std::vector<Vector3d> v;
  for (const Vec3& p : vertices) v.push_back(toEigen(p));
  return ltcPolygonIntegral(Ltc(toEigen(inverse).inverse()), v);
}

double condition(const Mat3& inverse) {
  return toEigen(inverse).norm() * toEigen(inverse).inverse().norm();
}

TEST_P(ShaderPolygon, ArcIsTheHalfAngleOverTheSine) {
  double worst = 0.0;
  for (int i = 0; i <= 100000; ++i) {
    // up to the last 1e-3 before 180 degrees, where the length of a + b says what the angle is
    const auto m2 = static_cast<float>(1e-6 + (4.0 - 1e-6) * i / 100000.0);
    const double half = std::acos(0.5 * std::sqrt(static_cast<double>(m2)));
    const double should = half == 0.0 ? 0.5 : half / std::sin(2.0 * half);
    raise(worst, std::abs(static_cast<double>(shader().arc(m2)) / should - 1.0));
  }
  // 7.4e-8 of the polynomial, and its arithmetic and the root's in float32
  EXPECT_LT(worst, 3e-7);
}

TEST_P(ShaderPolygon, QuadAgrees) {
  double worst = 0.0;
  int positive = 0;
  for (int i = 0; i < 40000; ++i) {
    const Mat3 inv = inverse(i);
    const Quad q = quad(logUniform(0.01, 3.0), 1.0);
    const double is = static_cast<double>(shader().quad(inv, q));
    const double should = expected(inv, q);
    raise(worst, std::abs(is - should) / condition(inv));
    if (should > 1e-3) ++positive;
  }
  // Rounding of a vertex, 6e-8, grows by the condition on its way to the cosine.
  EXPECT_LT(worst, 2e-7);
  EXPECT_GT(positive, 2000);
}

TEST_P(ShaderPolygon, NeedlesAgree) {
  double worst = 0.0;
  for (int i = 0; i < 40000; ++i) {
    const Mat3 inv = inverse(i);
    const Quad q = quad(logUniform(0.01, 3.0), logUniform(1e-6, 0.1));
    worst = std::max(
        worst, std::abs(static_cast<double>(shader().quad(inv, q)) - expected(inv, q)) / condition(inv));
  }
  // Two long edges that nearly pass the point nearly cancel, and have planes known to 6e-8 over their
  // distance.
  EXPECT_LT(worst, 5e-6);
}

TEST_P(ShaderPolygon, DistantLightsKeepTheirDigits) {
  for (double size : {1e-1, 1e-2, 1e-3, 1e-4}) {
    double worst = 0.0;
    for (int i = 0; i < 5000; ++i) {
      Quad q = quad(size, 1.0);
      const double should = expected(kIdentity, q);
      // seen at a fair angle, well above the horizon
      if (std::abs(should) < 0.2 * size * size) continue;
      raise(worst, std::abs(static_cast<double>(shader().quad(kIdentity, q)) / should - 1.0));
    }
    // Vertices are good to 6e-8, an edge so to 6e-8 over the size. Through a x b instead of a x (b - a) it
    // would be over its square: 2e-2 and 2 for the two smallest.
    EXPECT_LT(worst, 1e-6 / size) << size;
  }
}

TEST_P(ShaderPolygon, SmallLightsThroughTheHorizonKeepTheirDigits) {
  for (double size : {1e-1, 1e-2, 1e-3}) {
    double worst = 0.0;
    int crossing = 0;
    for (int i = 0; i < 20000; ++i) {
      Vector3d c = direction();
      c.z() = uniform(-size, size);
      const Vector3d a = direction() * size;
      const Vector3d b = direction() * size;
      const Quad q{toVec3(c - a - b), toVec3(c + a - b), toVec3(c + a + b), toVec3(c - a + b)};
      const double should = expected(kIdentity, q);
      // at the horizon the form factor of all of it is of this order
      if (std::abs(should) < 0.1 * size * size) continue;
      ++crossing;
      raise(worst, std::abs(static_cast<double>(shader().quad(kIdentity, q)) / should - 1.0));
    }
    // As above; the height over the horizon, up to the size times the value's cosine, is good to 6e-8 too.
    EXPECT_LT(worst, 1e-5 / size) << size;
    EXPECT_GT(crossing, 20);
  }
}

TEST_P(ShaderPolygon, QuadsNeedNotBeConvex) {
  double worst = 0.0;
  int fourCrossings = 0;
  for (int i = 0; i < 40000; ++i) {
    const Vector3d c = direction();
    const Vector3d a = direction() * uniform(0.1, 1.0);
    const Vector3d b = direction() * uniform(0.1, 1.0);
    const Quad q{toVec3(c + a), toVec3(c + uniform(-0.5, 0.5) * a + b), toVec3(c - uniform(-0.8, 1.0) * a),
                 toVec3(c + uniform(-0.5, 0.5) * a - b)};
    int crossings = 0;
    for (std::size_t k = 0; k < 4; ++k) crossings += (q[k][2] > 0.0f) != (q[(k + 1) % 4][2] > 0.0f) ? 1 : 0;
    if (crossings == 4) ++fourCrossings;
    raise(worst, std::abs(static_cast<double>(shader().quad(kIdentity, q)) - expected(kIdentity, q)));
  }
  // as in QuadAgrees, with the condition of the unit matrix, 3
  EXPECT_LT(worst, 6e-7);
  EXPECT_GT(fourCrossings, 100);
}

TEST_P(ShaderPolygon, TheUnitOfLengthDoesNotMatter) {
  for (float unit : {1e-13f, 1e-10f, 1e-5f, 1e5f, 1e10f, 1e13f}) {
    for (int i = 0; i < 200; ++i) {
      const Mat3 inv = inverse(i);
      Quad q = quad(0.5, 1.0);
      const float one = shader().quad(inv, q);
      for (Vec3& v : q) v = {v[0] * unit, v[1] * unit, v[2] * unit};
      EXPECT_NEAR(shader().quad(inv, q), one, 2e-7 * condition(inv)) << unit;
    }
  }
}

TEST_P(ShaderPolygon, WindingGivesTheSign) {
  for (int i = 0; i < 2000; ++i) {
    const Mat3 inv = inverse(i);
    const Quad q = quad(0.5, 1.0);
    // the same edges with a and b exchanged
    EXPECT_NEAR(shader().quad(inv, q), -shader().quad(inv, {q[3], q[2], q[1], q[0]}), 2e-7 * condition(inv));
  }
}

TEST_P(ShaderPolygon, HorizonIsExact) {
  // below: exactly 0; a vertex or an edge on the horizon: as in double, nothing special
  for (int i = 0; i < 2000; ++i) {
    Quad q = quad(1.0, 1.0);
    Quad below = q;
    for (Vec3& v : below) v[2] = -std::abs(v[2]);
    EXPECT_EQ(shader().quad(kIdentity, below), 0.0f);
    const auto height = static_cast<float>(uniform(0.1, 1.0));
    const auto distance = static_cast<float>(uniform(0.1, 3.0));
    const auto half = static_cast<float>(uniform(0.1, 3.0));
    const Quad standing{Vec3{distance, half, 0.0f}, Vec3{distance, -half, 0.0f},
                        Vec3{distance, -half, height}, Vec3{distance, half, height}};
    EXPECT_NEAR(shader().quad(kIdentity, standing), expected(kIdentity, standing), 2e-7);
    const Quad tip{Vec3{distance, 0.0f, 0.0f}, Vec3{distance, half, height},
                   Vec3{distance, 0.0f, 2.0f * height}, Vec3{distance, -half, height}};
    EXPECT_NEAR(shader().quad(kIdentity, tip), expected(kIdentity, tip), 2e-7);
    const Quad crossing{Vec3{distance, 0.0f, -height}, Vec3{distance, half, 0.0f},
                        Vec3{distance, 0.0f, height}, Vec3{distance, -half, 0.0f}};
    EXPECT_NEAR(shader().quad(kIdentity, crossing), expected(kIdentity, crossing), 2e-7);
  }
  const Quad flat{Vec3{1.0f, 1.0f, 0.0f}, Vec3{-1.0f, 1.0f, 0.0f}, Vec3{-1.0f, -1.0f, 0.0f},
                  Vec3{1.0f, -1.0f, 0.0f}};
  EXPECT_EQ(shader().quad(kIdentity, flat), 0.0f);
}

TEST_P(ShaderPolygon, VertexAtThePointCountsNothing) {
  // Its two edges pass through the point; the others close the polygon, as in double.
  for (int i = 0; i < 2000; ++i) {
    const Mat3 inv = inverse(i);
    Quad q = quad(1.0, 1.0);
    q[static_cast<std::size_t>(i) % 4] = {0.0f, 0.0f, 0.0f};
    EXPECT_NEAR(shader().quad(inv, q), expected(inv, q), 2e-7 * condition(inv)) << i;
  }
}

TEST_P(ShaderPolygon, IsFiniteForEveryFiniteVertex) {
  const std::vector<float> parts{-1.0f, 0.0f, 1e-45f, 1e-38f, 1e-20f, 3e-5f, 1.0f, 1e10f, 1e37f};
  const std::vector<Mat3> inverses{inverse(0), inverse(1), inverse(2), inverse(3), Mat3{}};
  for (int i = 0; i < 200000; ++i) {
    const auto part = [&] {
      const float p = parts[static_cast<std::size_t>(uniform(0.0, 9.0))];
      return uniform(0.0, 1.0) < 0.5 ? p : -p;
    };
    Quad q;
    for (Vec3& v : q) v = {part(), part(), part()};
    if (i % 3 == 0) q[1] = q[0];                            // an edge without length
    if (i % 5 == 0) q[2] = {-q[3][0], -q[3][1], -q[3][2]};  // and one through the point
    const float is = shader().quad(inverses[static_cast<std::size_t>(i) % inverses.size()], q);
    // four edges and a horizon of at most half a turn each
    ASSERT_LE(std::abs(is), 2.5f + 1e-6f) << i;
  }
}

TEST_P(ShaderPolygon, PolygonsOfAnyCountAgree) {
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Mat3 inv = inverse(i);
    const Vector3d c = direction() * logUniform(0.1, 10.0);
    const Vector3d a = direction() * c.norm();
    const Vector3d b = direction() * c.norm();
    const int n = 3 + i % 6;
    std::vector<Vec3> v;
    for (int k = 0; k < n; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / n;
      const double radius = uniform(0.1, 1.0);  // seldom convex
      v.push_back(toVec3(c + radius * (a * std::cos(angle) + b * std::sin(angle))));
    }
    worst = std::max(
        worst, std::abs(static_cast<double>(shader().polygon(inv, v)) - expected(inv, v)) / condition(inv));
    if (n == 4) {
      EXPECT_EQ(shader().polygon(inv, v), shader().quad(inv, {v[0], v[1], v[2], v[3]}));
    }
  }
  // as for quads
  EXPECT_LT(worst, 2e-7);
}

TEST_P(ShaderPolygon, AgreesFromTheWorldToTheIntegral) {
  const Texture texture = anisotropicTexture(anisotropicTable());
  double worst = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3d n = direction();
    const Vector3d t = n.cross(direction()).normalized();
    Vector3d v = direction();
    if (v.dot(n) < 0.0) v -= 2.0 * n * v.dot(n);
    const double alphaX = uniform(0.05, 1.0);
    const double alphaY = uniform(0.05, 1.0);
    const Quad light = quad(0.5, 1.0);

    const Mat3 frame = shader().frame(toVec3(n), toVec3(t));
    const auto local = [&](const Vec3& p) { return toVec3(toEigen(frame) * toEigen(p)); };
    const ShaderEntry e = shader().fetchAnisotropic(texture, 8, 8, static_cast<float>(alphaX),
                                                    static_cast<float>(alphaY), local(toVec3(v)));
    const float is =
        shader().quad(e.inverse, {local(light[0]), local(light[1]), local(light[2]), local(light[3])});

    Eigen::Matrix3d exact;
    exact << t.transpose(), n.cross(t).transpose(), n.transpose();
    const Vector3d w = exact * v;
    const TableEntry entry = anisotropicTable().fetch(
        {alphaX, alphaY, std::atan2(std::hypot(w.x(), w.y()), w.z()), std::atan2(w.y(), w.x())});
    std::vector<Vector3d> vertices;
    for (const Vec3& p : light) vertices.push_back(exact * toEigen(p));
    raise(worst, std::abs(static_cast<double>(is) - ltcPolygonIntegral(Ltc(entry.m), vertices)));
  }
  // the look-up's 4e-6 (shader_fetch_test.cpp) times conditions up to some 60, and the slope of the integral
  EXPECT_LT(worst, 2e-5);
}

}  // namespace
}  // namespace ltcfit::test
