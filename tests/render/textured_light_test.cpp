// Where prefiltered textures are read: configurations whose answer is known, and colours against the integral
// that they stand for.
#include "render/textured_light.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <vector>

#include "ggx/random.h"
#include "render/light_textures.h"
#include "tests/render/tables.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Quad = std::array<Vector3d, 4>;

Quad parallelogram(const Vector3d& corner, const Vector3d& side1, const Vector3d& side2) {
  return {corner, corner + side1, corner + side1 + side2, corner + side2};
}

TEST(TextureFetch, OverheadIsTheProjection) {
  // 4 x 2, 3 above the point, which lies under a quarter of the way along u and three quarters along v
  const Quad light = parallelogram({-1.0, -1.5, 3.0}, {4.0, 0.0, 0.0}, {0.0, 2.0, 0.0});
  const TextureFetch fetch = textureFetch(Matrix3d::Identity(), light);
  EXPECT_NEAR(fetch.uv.x(), 0.25, 1e-14);
  EXPECT_NEAR(fetch.uv.y(), 0.75, 1e-14);
  EXPECT_NEAR(fetch.sigma, std::sqrt(9.0 / 16.0), 1e-14);
}

TEST(TextureFetch, SkewedByTheInverse) {
  // against the projection found by least squares
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const auto vector = [&] { return Vector3d(random.normal(), random.normal(), random.normal()); };
    Matrix3d inverse;
    inverse << vector(), vector(), vector();
    const Quad light = parallelogram(2.0 * vector(), vector(), vector());
    Eigen::Matrix<double, 3, 2> sides;
    sides << inverse * (light[1] - light[0]), inverse * (light[3] - light[0]);
    const Vector3d corner = inverse * light[0];
    const Vector2d uv = sides.colPivHouseholderQr().solve(-corner);
    const double r = (corner + sides * uv).norm();
    const double area = sides.col(0).cross(sides.col(1)).norm();
    const TextureFetch fetch = textureFetch(inverse, light);
    EXPECT_LE((fetch.uv - uv).norm(), 1e-9 * (1.0 + uv.norm())) << i;
    EXPECT_NEAR(fetch.sigma / std::sqrt(r * r / (2.0 * area)), 1.0, 1e-9) << i;
    // the scale of neither matters
    Quad larger = light;
    for (Vector3d& v : larger) v *= 1e6;
    const TextureFetch same = textureFetch(1e-5 * inverse, larger);
    EXPECT_LE((same.uv - fetch.uv).norm(), 1e-9 * (1.0 + uv.norm()));
    EXPECT_NEAR(same.sigma / fetch.sigma, 1.0, 1e-9);
  }
}

TEST(TextureFetch, NeverNan) {
  const PrefilteredTexture texture = prefilter(diskMask(16), {});
  const Vector3d p(1.0, 2.0, 0.5);
  const Vector3d x = Vector3d::UnitX();
  const Vector3d y = Vector3d::UnitY();
  const double huge = std::numeric_limits<double>::max() / 1e10;
  for (const Quad& light :
       {parallelogram(p, x, Vector3d::Zero()), parallelogram(p, x, 2.0 * x), Quad{p, p, p, p},
        parallelogram({-0.5, -0.5, 0.0}, x, y), parallelogram({0.0, 0.0, 0.0}, x, y),
        Quad{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()},
        parallelogram(huge * p, huge * x, huge * y), parallelogram(1e-300 * p, 1e-300 * x, 1e-300 * y),
        parallelogram(1e12 * p, 1e-12 * x, y), parallelogram(p, x, 1e-12 * y)}) {
    for (const Matrix3d& inverse :
         {Matrix3d(Matrix3d::Identity()), Matrix3d(Vector3d(1e6, 1.0, 1e-6).asDiagonal()),
          Matrix3d(Matrix3d::Zero())}) {
      const TextureFetch fetch = textureFetch(inverse, light);
      EXPECT_TRUE(fetch.uv.allFinite());
      EXPECT_TRUE(std::isfinite(fetch.sigma) && fetch.sigma > 0.0) << fetch.sigma;
      const Vector3d colour = fetchPrefiltered(texture, inverse, light);
      EXPECT_TRUE(colour.minCoeff() >= 0.0 && colour.maxCoeff() <= 1.0) << colour.transpose();
    }
  }
}

TEST(TextureFetch, OrientationOfThePicture) {
  // red top left, green top right, blue bottom left, white bottom right
  const LightTexture picture{
      "", 2, 2, {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ(), Vector3d::Ones()}};
  PrefilterOptions options;
  options.size = 64;
  const PrefilteredTexture texture = prefilter(picture, options);
  const auto under = [&](double u, double v) {
    const Quad light = parallelogram({-u, -v, 1e-3}, Vector3d::UnitX(), Vector3d::UnitY());
    return fetchPrefiltered(texture, Matrix3d::Identity(), light);
  };
  EXPECT_LE((under(0.1, 0.1) - Vector3d::UnitX()).norm(), 0.01);
  EXPECT_LE((under(0.9, 0.1) - Vector3d::UnitY()).norm(), 0.01);
  EXPECT_LE((under(0.1, 0.9) - Vector3d::UnitZ()).norm(), 0.01);
  EXPECT_LE((under(0.9, 0.9) - Vector3d::Ones()).norm(), 0.01);
}

// Lights of unit area around points under lobes of the isotropic table, with the weights of the points of a
// grid on each: eq. 14 by sums.
class PrefilterAccuracy : public testing::Test {
 protected:
  static constexpr int kSteps = 64;
  struct Case {
    Matrix3d inverse;
    Quad light;
    double integral = 0.0;          // of the lobe over the light
    std::vector<Vector3d> colours;  // exactly, of each picture
  };

  std::vector<Case> cases(double aspect) const {
    Random random(3);
    const auto within = [&] { return 2.0 * random.uniform() - 1.0; };
    std::vector<Case> all;
    while (all.size() < 120) {
      Case c;
      const Vector3d normal = Vector3d(within(), within(), within() + 1e-3).normalized();
      const Vector3d side = Eigen::AngleAxisd(std::numbers::pi * within(), normal) * normal.unitOrthogonal();
      const Vector3d side1 = std::sqrt(aspect) * side;
      const Vector3d side2 = normal.cross(side) / std::sqrt(aspect);
      const Vector3d centre(1.5 * within(), 1.5 * within(), 1.5 * random.uniform());
      c.light = parallelogram(centre - 0.5 * (side1 + side2), side1, side2);
      LobeParameters lobe;
      lobe.alphaX = lobe.alphaY = std::pow(0.1 + 0.9 * random.uniform(), 2);
      lobe.theta = 1.5 * random.uniform();
      c.inverse = test::isotropicTable().fetch(lobe).mInv;
      if (textureFetch(c.inverse, c.light).sigma < 0.04) continue;  // too sharp for the sums
      c.colours.assign(pictures_.size(), Vector3d::Zero());
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const Vector3d p = c.inverse * (c.light[0] + (i % kSteps + 0.5) / kSteps * side1 +
                                        (i / kSteps + 0.5) / kSteps * side2);
        const double weight = std::max(p.z(), 0.0) / std::pow(p.squaredNorm(), 2);
        c.integral += weight;
        for (std::size_t k = 0; k < pictures_.size(); ++k)
          c.colours[k] += weight * pictures_[k].texels[static_cast<std::size_t>(i)];
      }
      if (c.integral == 0.0) continue;
      for (Vector3d& colour : c.colours) colour /= c.integral;
      const Vector3d area = (c.inverse * side1).cross(c.inverse * side2);
      c.integral *= std::abs(area.dot(c.inverse * c.light[0])) / (std::numbers::pi * kSteps * kSteps);
      if (c.integral > 0.002) all.push_back(std::move(c));
    }
    return all;
  }

  // Root mean square over cases, pictures and channels of the colours' errors, weighted by the light.
  double error(const std::vector<Case>& all, const PrefilterOptions& options) const {
    double sum = 0.0;
    double light = 0.0;
    for (std::size_t k = 0; k < pictures_.size(); ++k) {
      const PrefilteredTexture texture = prefilter(pictures_[k], options);
      for (const Case& c : all) {
        const Vector3d found = fetchPrefiltered(texture, c.inverse, c.light);
        sum += c.integral * c.integral * (found - c.colours[k]).squaredNorm() / 3.0;
        light += c.integral * c.integral;
      }
    }
    return std::sqrt(sum / light);
  }

 private:
  std::vector<LightTexture> pictures_{colourGradient(kSteps), stainedGlass(kSteps, 1), diskMask(kSteps),
                                      checker(kSteps, 8)};
};

TEST_F(PrefilterAccuracy, OfTheDefaultsAndBesideThem) {
  const std::vector<Case> all = cases(1.0);
  PrefilterOptions options;
  const double standard = error(all, options);
  EXPECT_LT(standard, 0.06);  // colours are up to 1; measured 0.05
  for (const double margin : {0.125, 0.25, 0.5, 1.0}) {
    options.margin = margin;
    const double other = error(all, options);
    std::printf("margin %.3f: %.4f\n", margin, other);
    EXPECT_GT(other, 0.98 * standard) << "margin " << margin;
  }
  options = {};
  for (const double spread : {0.5, 0.7, 1.0, 1.4, 2.0, 2.8}) {
    options.spread = spread;
    const double other = error(all, options);
    std::printf("spread %.2f: %.4f\n", spread, other);
    EXPECT_GT(other, 0.98 * standard) << "spread " << spread;
  }
}

TEST_F(PrefilterAccuracy, AspectHelpsLongLights) {
  const std::vector<Case> all = cases(4.0);
  PrefilterOptions options;
  const double square = error(all, options);
  options.aspect = 4.0;
  const double fitting = error(all, options);
  options.aspect = 0.25;
  const double wrong = error(all, options);
  std::printf("light of 4 x 1: aspect 1: %.4f, 4: %.4f, 1/4: %.4f\n", square, fitting, wrong);
  EXPECT_LT(fitting, 0.8 * square);
  EXPECT_GT(wrong, square);
}

}  // namespace
}  // namespace ltcfit
