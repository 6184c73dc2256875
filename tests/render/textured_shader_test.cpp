// The shader snippets of textured lights against the same in double.
#include "tests/render/textured_shader.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "ggx/random.h"
#include "render/light_textures.h"
#include "render/textured_light.h"
#include "tests/render/tables.h"

namespace ltcfit::test {
namespace {

using Eigen::Vector3d;
using Quad = std::array<Vector3d, 4>;

constexpr Mat3 kIdentity{{{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}}};

Quad parallelogram(const Vector3d& corner, const Vector3d& side1, const Vector3d& side2) {
  return {corner, corner + side1, corner + side1 + side2, corner + side2};
}

class TexturedShaderTest : public testing::TestWithParam<TexturedShader> {
 protected:
  TexturedShaderTest() {
    PrefilterOptions options;
    options.threads = 1;
    texture_ = prefilter(stainedGlass(64, 5), options);
    for (const PrefilteredLevel& level : texture_.levels) {
      Texture t{static_cast<int>(level.size), static_cast<int>(level.size), 1, {}};
      for (const Vector3d& texel : level.texels)
        t.texels.push_back({static_cast<float>(texel.x()), static_cast<float>(texel.y()),
                            static_cast<float>(texel.z()), 1.0f});
      mips_.push_back(std::move(t));
    }
  }

  Vector3d colour(const Mat3& inverse, const Quad& light) const {
    std::array<Vec3, 4> vertices;
    for (std::size_t i = 0; i < 4; ++i) vertices[i] = toVec3(light[i]);
    return toEigen(GetParam().lightColour(inverse, vertices, mips_, static_cast<float>(texture_.margin),
                                          static_cast<float>(texture_.lodScale)));
  }
  const PrefilteredTexture& texture() const { return texture_; }

 private:
  PrefilteredTexture texture_;
  MipMaps mips_;
};

TEST_P(TexturedShaderTest, AgreesWithDouble) {
  Random random(1);
  double worst = 0.0;
  double swapped = 0.0;
  for (int i = 0; i < 20000; ++i) {
    LobeParameters lobe;
    lobe.alphaX = lobe.alphaY = std::pow(0.05 + 0.95 * random.uniform(), 2);
    lobe.theta = 1.5 * random.uniform();
    Eigen::Matrix3d inverse = isotropicTable().fetch(lobe).mInv;
    inverse = inverse.cast<float>().cast<double>();
    const auto vector = [&] { return Vector3d(random.normal(), random.normal(), random.normal()); };
    const Vector3d side1 = vector();
    const Vector3d side2 = side1.cross(vector()).normalized() * std::exp(random.normal());
    Quad light = parallelogram(vector() * std::exp(random.normal()), side1, side2);
    for (Vector3d& v : light) v = v.cast<float>().cast<double>();
    Mat3 rows;
    for (std::size_t r = 0; r < 3; ++r)
      rows[r] = toVec3(inverse.row(static_cast<Eigen::Index>(r)).transpose());
    const Vector3d expected = fetchPrefiltered(texture(), inverse, light);
    raise(worst, (colour(rows, light) - expected).cwiseAbs().maxCoeff());
    std::swap(light[1], light[3]);  // the picture mirrored at its diagonal
    raise(swapped, (colour(rows, light) - expected).cwiseAbs().maxCoeff());
  }
  std::printf("%s: worst difference %.2g\n", GetParam().name, worst);
  // float32 through inverses of condition 1e3, on edges as steep as 1 a texel of 1/64
  EXPECT_LT(worst, 1e-3);
  EXPECT_GT(swapped, 0.3);
}

TEST_P(TexturedShaderTest, Orientation) {
  // by the corner that lies above the point
  for (const auto& [u, v] : {std::pair{0.2, 0.1}, {0.9, 0.3}, {0.6, 0.8}}) {
    const Quad light = parallelogram({-u, -v, 0.02}, Vector3d::UnitX(), Vector3d::UnitY());
    const Vector3d expected =
        sampleTrilinear(texture(), {u, v}, lodOfSigma(texture(), 0.02 / std::sqrt(2.0)));
    EXPECT_LE((colour(kIdentity, light) - expected).cwiseAbs().maxCoeff(), 1e-4);
  }
}

TEST_P(TexturedShaderTest, NeverNan) {
  const Vector3d p(1.0, 2.0, 0.5);
  const Vector3d x = Vector3d::UnitX();
  const Vector3d y = Vector3d::UnitY();
  const double most = std::numeric_limits<float>::max() / 4.0;
  const auto diagonal = [](float a, float b, float c) {
    return Mat3{{{a, 0.0f, 0.0f}, {0.0f, b, 0.0f}, {0.0f, 0.0f, c}}};
  };
  for (const Quad& light :
       {parallelogram(p, x, Vector3d::Zero()), parallelogram(p, x, 2.0 * x), Quad{p, p, p, p},
        parallelogram({-0.5, -0.5, 0.0}, x, y), parallelogram({0.0, 0.0, 0.0}, x, y),
        Quad{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()},
        parallelogram(most / 4.0 * p, most * x, most * y), parallelogram(1e-38 * p, 1e-38 * x, 1e-38 * y),
        parallelogram(1e-44 * p, 1e-44 * x, 1e-44 * y), parallelogram(1e12 * p, 1e-12 * x, y),
        parallelogram(1e18 * p, x, y), parallelogram(p, x, 1e-12 * y), parallelogram(p, 1e20 * x, y)}) {
    for (const Mat3& inverse : {kIdentity, diagonal(1e6f, 1.0f, 1e-6f), diagonal(1e30f, 1e30f, 1e30f),
                                diagonal(1e-30f, 1e-30f, 1e-30f), diagonal(0.0f, 0.0f, 0.0f)}) {
      const Vector3d c = colour(inverse, light);
      EXPECT_TRUE(c.minCoeff() >= -1e-6 && c.maxCoeff() <= 1.0 + 1e-6) << c.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Languages, TexturedShaderTest, testing::Values(kTexturedGlsl, kTexturedHlsl),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace ltcfit::test
