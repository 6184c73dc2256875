// The look-ups of the shader snippets against Table::fetch in double.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "tests/render/tables.h"

namespace ltcfit::test {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

class ShaderFetch : public testing::TestWithParam<Shader> {
 protected:
  ShaderFetch() : texture_(anisotropicTexture(anisotropicTable())) {}

  const Shader& shader() const { return GetParam(); }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  ShaderEntry fetch(float alphaX, float alphaY, const Vec3& view) const {
    return shader().fetchAnisotropic(texture_, 8, 8, alphaX, alphaY, view);
  }

  Texture texture_;

 private:
  std::mt19937 random_{1};
};
INSTANTIATE_TEST_SUITE_P(Languages, ShaderFetch, testing::Values(kGlsl, kHlsl),
                         [](const auto& instance) { return instance.param.name; });

double condition(const TableEntry& e) {
  return e.m.norm() * e.mInv.norm();
}

Vec3 direction(double theta, double phi) {
  return toVec3(
      Eigen::Vector3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
}

// What the table holds for the float32 arguments that the shader gets.
TableEntry expected(float alphaX, float alphaY, const Vec3& view) {
  const Eigen::Vector3d v = toEigen(view);
  return anisotropicTable().fetch({static_cast<double>(alphaX), static_cast<double>(alphaY),
                                   std::atan2(std::hypot(v.x(), v.y()), v.z()), std::atan2(v.y(), v.x())});
}

// Largest error of fetched entries: of the matrix, as displacement over condition, norm and Fresnel.
struct Worst {
  double matrix = 0.0;
  double norm = 0.0;
  double fresnel = 0.0;

  void add(const ShaderEntry& is, const TableEntry& should) {
    raise(matrix, displacement(is.inverse, should.m) / condition(should));
    raise(norm, std::abs(static_cast<double>(is.norm) - *should.norm));
    raise(fresnel, std::abs(static_cast<double>(is.fresnel) - *should.fresnel));
  }
  // A unit of float32 in a slice coordinate is 1.5e-5 of a texel at slice 191, and neighbours differ by up to
  // 0.3: M is good to some 5e-6 of its largest entry, and its inverse to the condition times as much.
  void expectFloat32(double factor = 1.0) const {
    EXPECT_LT(matrix, 4e-6 * factor);
    EXPECT_LT(norm, 4e-6 * factor);
    EXPECT_LT(fresnel, 1e-5 * factor);
  }
};

TEST_P(ShaderFetch, AgreesForEveryViewAndRoughness) {
  Worst worst;
  for (int i = 0; i < 20000; ++i) {
    // every second pair down to 1e-4, where lambda too is any
    const bool sharp = i % 2 == 1;
    const auto alpha = [&] {
      return static_cast<float>(sharp ? std::pow(10.0, uniform(-4.0, 0.0)) : uniform(0.0, 1.0));
    };
    const float alphaX = alpha();
    const float alphaY = alpha();
    const Vec3 view = direction(uniform(0.0, kHalfPi), uniform(0.0, 4.0 * kHalfPi));
    worst.add(fetch(alphaX, alphaY, view), expected(alphaX, alphaY, view));
  }
  worst.expectFloat32();
}

TEST_P(ShaderFetch, AgreesAtTheEndsOfTheAxes) {
  Worst worst;
  Worst lambda0;
  for (int i = 0; i < 3000; ++i) {
    const auto alpha = static_cast<float>(uniform(0.0, 1.0));
    const auto other = static_cast<float>(uniform(0.0, 1.0));
    const double theta = uniform(0.0, kHalfPi);
    const double phi = uniform(0.0, 4.0 * kHalfPi);
    const double axis = kHalfPi * static_cast<double>(i % 4);
    Vec3 grazing = direction(kHalfPi, phi);
    grazing[2] = 0.0f;
    worst.add(fetch(0.0f, 0.0f, direction(theta, phi)), expected(0.0f, 0.0f, direction(theta, phi)));
    worst.add(fetch(1.0f, 1.0f, direction(theta, phi)), expected(1.0f, 1.0f, direction(theta, phi)));
    worst.add(fetch(alpha, alpha, direction(theta, phi)), expected(alpha, alpha, direction(theta, phi)));
    worst.add(fetch(alpha, other, {0.0f, 0.0f, 1.0f}), expected(alpha, other, {0.0f, 0.0f, 1.0f}));
    worst.add(fetch(alpha, other, grazing), expected(alpha, other, grazing));
    worst.add(fetch(alpha, other, direction(theta, axis)), expected(alpha, other, direction(theta, axis)));
    lambda0.add(fetch(alpha, 0.0f, direction(theta, phi)), expected(alpha, 0.0f, direction(theta, phi)));
    lambda0.add(fetch(0.0f, alpha, direction(theta, phi)), expected(0.0f, alpha, direction(theta, phi)));
  }
  worst.expectFloat32();
  // there the shader stays 5.8e-5 of a texel inside the block (ltc.glsl), four units of float32
  lambda0.expectFloat32(5.0);
}

TEST_P(ShaderFetch, IsContinuousAcrossTheSeams) {
  const auto jump = [&](float ax0, float ay0, const Vec3& v0, float ax1, float ay1, const Vec3& v1) {
    const TableEntry e = expected(ax1, ay1, v1);
    // the matrix itself and not only its lobe: winding and x, y of the cosine go on
    const Eigen::Matrix3d one = toEigen(fetch(ax0, ay0, v0).inverse);
    const Eigen::Matrix3d two = toEigen(fetch(ax1, ay1, v1).inverse);
    return (one - two).cwiseAbs().maxCoeff() / condition(e);
  };
  for (int i = 0; i < 1000; ++i) {
    const auto alphaX = static_cast<float>(uniform(0.01, 1.0));
    const auto alphaY = static_cast<float>(uniform(0.01, 1.0));
    const double theta = uniform(0.0, kHalfPi);
    const double phi = uniform(0.0, 4.0 * kHalfPi);
    const double axis = kHalfPi * static_cast<double>(i % 4);
    const float step = 1e-6f;  // some units of float32, so that both sides are met
    // four times the bound of a single look-up, and the step itself
    EXPECT_LT(
        jump(alphaX, alphaY, direction(theta, axis - 1e-6), alphaX, alphaY, direction(theta, axis + 1e-6)),
        2e-5);
    EXPECT_LT(
        jump(alphaX - step, alphaX, direction(theta, phi), alphaX + step, alphaX, direction(theta, phi)),
        2e-5);
    EXPECT_LT(jump(alphaX, alphaY, direction(1e-6, phi), alphaX, alphaY, direction(1e-6, -phi)), 2e-5);
  }
}

TEST_P(ShaderFetch, TheComparisonTellsLobesApart) {
  // a quadrant, an order of roughness, or the side of a factor that is wrong must not pass for rounding
  const Vec3 view = direction(0.9, 0.6);
  const ShaderEntry e = fetch(0.5f, 0.2f, view);
  EXPECT_LT(displacement(e.inverse, expected(0.5f, 0.2f, view).m), 1e-4);
  EXPECT_GT(displacement(e.inverse, expected(0.2f, 0.5f, view).m), 0.05);
  EXPECT_GT(displacement(e.inverse, expected(0.5f, 0.2f, direction(0.9, -0.6)).m), 0.05);
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal();
  EXPECT_GT(displacement(e.inverse, expected(0.5f, 0.2f, direction(0.9, -0.6)).m * mirror), 0.05);
  ShaderEntry broken = e;
  broken.inverse[1][1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(std::isfinite(displacement(broken.inverse, expected(0.5f, 0.2f, view).m)));
}

TEST_P(ShaderFetch, BlocksOfLambdaDoNotBleed) {
  // A unit with 8 bits of fraction snaps to texel centres: at nodes it must give the node, at the first and
  // last lambda too, whose neighbours belong to another alpha or row.
  texture_.fractionBits = 8;
  const auto& axes = anisotropicTable().info().axes;
  for (std::size_t i = 0; i < anisotropicTable().nodeCount(); ++i) {
    const auto node = anisotropicTable().node(i);
    if (node[0] == 0) continue;  // fitted at the floor, asked for at 0
    const double alpha = axes[0].values[node[0]];
    const Vec3 view = direction(axes[2].values[node[2]], axes[3].values[node[3]]);
    const ShaderEntry e =
        fetch(static_cast<float>(alpha), static_cast<float>(alpha * axes[1].values[node[1]]), view);
    const TableEntry stored = anisotropicTable().entry(node);
    // float32 of alpha, 6e-8 of 7 texels, and of the inverse
    EXPECT_LT(displacement(e.inverse, stored.m), 2e-6 * condition(stored)) << i;
    EXPECT_NEAR(static_cast<double>(e.norm), *stored.norm, 1e-6) << i;
    EXPECT_NEAR(static_cast<double>(e.fresnel), *stored.fresnel, 1e-6) << i;
  }
}

TEST_P(ShaderFetch, Float32CoordinatesDoNotBleed) {
  // What lies outside of the two alphas that are asked for is so large that the least of it would show.
  for (int nodes : {2, 8, 13, 32}) {
    for (int a = 0; a + 1 < nodes; ++a) {
      Texture texture;
      texture.width = texture.height = 2;
      texture.depth = 3 * nodes * nodes;
      for (int slice = 0; slice < texture.depth; ++slice) {
        const int row = slice / (nodes * nodes);
        const int alpha = slice / nodes % nodes;
        std::array<float, 4> texel{0.0f, 0.0f, 0.0f, 0.5f};
        texel[static_cast<std::size_t>(row)] = 1.0f;
        if (alpha != a && alpha != a + 1) texel.fill(1e20f);
        texture.texels.insert(texture.texels.end(), 4, texel);
      }
      const float alpha = (static_cast<float>(a) + 0.5f) / static_cast<float>(nodes - 1);
      for (float lambda : {0.0f, 1.0f}) {
        const ShaderEntry e =
            shader().fetchAnisotropic(texture, nodes, nodes, alpha, alpha * lambda, {0.3f, 0.2f, 0.9f});
        EXPECT_LT(displacement(e.inverse, Eigen::Matrix3d::Identity()), 1e-5)
            << nodes << ' ' << a << ' ' << lambda;
        EXPECT_NEAR(e.norm + e.fresnel, 1.0f, 1e-5f) << nodes << ' ' << a << ' ' << lambda;
      }
    }
  }
}

TEST_P(ShaderFetch, IsFiniteForEveryFiniteArgument) {
  const std::vector<float> alphas{-1.0f, 0.0f, 1e-45f, 1e-39f, 1e-20f, 1e-4f, 0.5f, 1.0f, 2.0f, 1e30f};
  const std::vector<float> parts{-1e18f, -1.0f, -1e-20f, -0.0f, 0.0f, 1e-45f, 1e-30f, 1e-7f, 1.0f, 1e18f};
  for (float ax : alphas) {
    for (float ay : alphas) {
      for (float x : parts) {
        for (float y : parts) {
          for (float z : parts) {
            const ShaderEntry e = fetch(ax, ay, {x, y, z});
            ASSERT_TRUE(toEigen(e.inverse).allFinite() && std::isfinite(e.norm) && std::isfinite(e.fresnel))
                << ax << ' ' << ay << ' ' << x << ' ' << y << ' ' << z;
          }
        }
      }
    }
  }
}

TEST_P(ShaderFetch, IsotropicAgrees) {
  const IsotropicTextures textures = isotropicTextures(isotropicTable());
  Worst worst;
  for (int i = 0; i < 20000; ++i) {
    const auto roughness = static_cast<float>(uniform(0.0, i % 4 == 0 ? 0.05 : 1.0));
    const auto cosine = static_cast<float>(uniform(0.0, i % 5 == 0 ? 0.01 : 1.0));
    const double alpha = static_cast<double>(roughness) * static_cast<double>(roughness);
    worst.add(shader().fetch(textures.matrix, textures.amplitude, roughness, cosine),
              isotropicTable().fetch({alpha, alpha, std::acos(static_cast<double>(cosine)), 0.0}));
  }
  // here slices do not add up, and it is the inverse that is stored
  worst.expectFloat32(0.25);
}

TEST_P(ShaderFetch, FrameIsOrthonormalAndRightHanded) {
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d n =
        toEigen(toVec3(Eigen::Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized()));
    const Eigen::Vector3d t =
        n.cross(Eigen::Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1))).normalized();
    const double tilt = std::pow(10.0, uniform(-9.0, 0.0));
    const Vec3 v = toVec3(Eigen::Vector3d(n + tilt * t).normalized());
    const Eigen::Matrix3d frame = toEigen(shader().frame(toVec3(n), v));
    // a few units of float32
    EXPECT_LT((frame * frame.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_NEAR(frame.determinant(), 1.0, 1e-6);
    EXPECT_EQ(frame.row(2).transpose(), n);
    const Eigen::Vector3d local = frame * toEigen(v);
    // straight from above x is any direction, and the view off the plane by what is there called straight
    EXPECT_NEAR(local.y(), 0.0, 1.2e-6);
    EXPECT_GT(local.x(), -1.2e-6);
  }
}

TEST_P(ShaderFetch, FresnelIsSchlicks) {
  const ShaderEntry e{{}, 0.75f, 0.125f};
  EXPECT_EQ(shader().fresnel(e, {1.0f, 0.5f, 0.0f}, {1.0f, 1.0f, 0.5f}), (Vec3{0.75f, 0.4375f, 0.0625f}));
}

}  // namespace
}  // namespace ltcfit::test
