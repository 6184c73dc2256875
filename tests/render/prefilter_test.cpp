// Prefiltered textures against the integral that defines them, done by brute force.
#include "render/prefilter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ggx/random.h"
#include "render/light_textures.h"
#include "render/textured_light.h"

namespace ltcfit {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

LightTexture noise(std::size_t width, std::size_t height) {
  Random random(7);
  LightTexture picture{"noise", width, height, {}};
  for (std::size_t i = 0; i < width * height; ++i)
    picture.texels.emplace_back(random.uniform(), random.uniform(), random.uniform());
  return picture;
}

Vector3d read(const LightTexture& picture, double u, double v) {
  const auto n = [](std::size_t size) { return static_cast<double>(size); };
  const double x = std::clamp(u * n(picture.width) - 0.5, 0.0, n(picture.width - 1));
  const double y = std::clamp(v * n(picture.height) - 0.5, 0.0, n(picture.height - 1));
  const auto x0 =
      std::min(static_cast<std::size_t>(x), picture.width - std::min<std::size_t>(picture.width, 2));
  const auto y0 =
      std::min(static_cast<std::size_t>(y), picture.height - std::min<std::size_t>(picture.height, 2));
  const auto at = [&](std::size_t i, std::size_t j) {
    return picture.texels[std::min(j, picture.height - 1) * picture.width + std::min(i, picture.width - 1)];
  };
  const double fx = x - n(x0);
  const double fy = y - n(y0);
  return (1 - fy) * ((1 - fx) * at(x0, y0) + fx * at(x0 + 1, y0)) +
         fy * ((1 - fx) * at(x0, y0 + 1) + fx * at(x0 + 1, y0 + 1));
}

// Sums over a grid of `steps` x `steps` points, relative to the nearest one so that nothing underflows.
Vector3d bruteForce(const LightTexture& picture, const Vector2d& at, double sigmaU, double sigmaV,
                    int steps = 500) {
  const Vector2d nearest = at.cwiseMax(0.0).cwiseMin(1.0);
  const auto exponent = [&](const Vector2d& p) {
    return 0.5 * (std::pow((p.x() - at.x()) / sigmaU, 2) + std::pow((p.y() - at.y()) / sigmaV, 2));
  };
  Vector3d sum = Vector3d::Zero();
  double total = 0.0;
  for (int j = 0; j < steps; ++j) {
    for (int i = 0; i < steps; ++i) {
      const Vector2d p((i + 0.5) / steps, (j + 0.5) / steps);
      const double weight = std::exp(exponent(nearest) - exponent(p));
      if (weight < 1e-12) continue;
      sum += weight * read(picture, p.x(), p.y());
      total += weight;
    }
  }
  return sum / total;
}

Vector2d coordinates(const PrefilteredTexture& texture, std::size_t level, std::size_t x, std::size_t y) {
  const auto size = static_cast<double>(texture.levels[level].size);
  const Vector2d at(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
  return (at / size * (1.0 + 2.0 * texture.margin)).array() - texture.margin;
}

double sigmaOfLevel(const PrefilteredTexture& texture, std::size_t level) {
  return kPrefilterSigma * (1.0 + 2.0 * texture.margin) /
         static_cast<double>(texture.levels[0].size >> level);
}

bool isInside(const Vector2d& p) {
  return p.minCoeff() >= 0.0 && p.maxCoeff() <= 1.0;
}

// Random texels of all levels, inside the picture or in its margin.
template <typename Check>
void atTexels(const PrefilteredTexture& texture, bool inside, int count, const Check& check) {
  Random random(11);
  while (count > 0) {
    const auto pick = [&](std::size_t n) {
      return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
    };
    const std::size_t level = pick(texture.levels.size());
    const std::size_t size = texture.levels[level].size;
    const std::size_t x = pick(size);
    const std::size_t y = pick(size);
    const Vector2d p = coordinates(texture, level, x, y);
    if (isInside(p) != inside) continue;
    check(level, p, texture.levels[level].texels[y * size + x]);
    --count;
  }
}

TEST(Prefilter, LevelsHalveDownToOneTexel) {
  const PrefilteredTexture texture = prefilter(noise(16, 16), {});
  EXPECT_EQ(texture.levels[0].size, 32u);  // the picture's resolution, with margins of half of it
  for (std::size_t l = 0; l < texture.levels.size(); ++l) {
    EXPECT_EQ(texture.levels[l].size, 32u >> l);
    EXPECT_EQ(texture.levels[l].texels.size(), texture.levels[l].size * texture.levels[l].size);
  }
  EXPECT_EQ(texture.levels.size(), 6u);
  PrefilterOptions options;
  options.margin = 0.1;
  EXPECT_EQ(prefilter(noise(16, 5), options).levels[0].size, 32u);  // 19.2 rounded up
  options.size = 8;
  EXPECT_EQ(prefilter(noise(16, 5), options).levels[0].size, 8u);
}

TEST(Prefilter, ConstantStaysConstant) {
  const Vector3d colour(0.25, 3.0, 1e-3);
  for (const double margin : {0.0, 0.5, 4.0}) {
    PrefilterOptions options;
    options.margin = margin;
    options.size = 64;
    const PrefilteredTexture texture = prefilter({"", 24, 9, std::vector<Vector3d>(24 * 9, colour)}, options);
    for (const PrefilteredLevel& level : texture.levels)
      for (const Vector3d& texel : level.texels) EXPECT_LE((texel - colour).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(Prefilter, InsideIsTheClampedGaussian) {
  const LightTexture picture = noise(16, 8);
  for (const double aspect : {1.0, 3.0}) {
    PrefilterOptions options;
    options.aspect = aspect;
    const PrefilteredTexture texture = prefilter(picture, options);
    atTexels(texture, true, 40, [&](std::size_t level, const Vector2d& p, const Vector3d& texel) {
      const double sigma = sigmaOfLevel(texture, level);
      const Vector3d expected = bruteForce(picture, p, sigma / std::sqrt(aspect), sigma * std::sqrt(aspect));
      // 500 points along a side, of which the narrowest Gaussian's sigma has 4
      EXPECT_LE((texel - expected).cwiseAbs().maxCoeff(), 2e-4)
          << "level " << level << " at " << p.transpose();
    });
  }
}

TEST(Prefilter, MarginBlendsGaussiansThatReachThePicture) {
  const LightTexture picture = noise(16, 16);
  const PrefilterOptions options;
  const PrefilteredTexture texture = prefilter(picture, options);
  double worstSingle = 0.0;
  atTexels(texture, false, 60, [&](std::size_t level, const Vector2d& p, const Vector3d& texel) {
    const double own = sigmaOfLevel(texture, level);
    const Vector2d nearest = p.cwiseMax(0.0).cwiseMin(1.0);
    const double sigma = std::hypot(own, options.spread * (p - nearest).norm());
    const double last = static_cast<double>(texture.levels.size() - 1 - level);
    const double rise = std::min(std::log2(sigma / own), last);
    const double low = own * std::exp2(std::floor(rise));
    const double f = rise - std::floor(rise);
    const Vector3d expected =
        (1.0 - f) * bruteForce(picture, p, low, low) + f * bruteForce(picture, p, 2.0 * low, 2.0 * low);
    // the blend reads images of a quarter of their sigma from texel to texel bilinearly
    EXPECT_LE((texel - expected).cwiseAbs().maxCoeff(), 4e-3) << "level " << level << " at " << p.transpose();
    const double reached = std::min(sigma, own * std::exp2(last));
    worstSingle =
        std::max(worstSingle, (texel - bruteForce(picture, p, reached, reached)).cwiseAbs().maxCoeff());
  });
  EXPECT_LE(worstSingle, 0.05);  // a blend of two Gaussians for the one between them
}

TEST(Prefilter, RampIsUnchangedFarFromEdges) {
  LightTexture ramp{"ramp", 64, 64, {}};
  for (std::size_t i = 0; i < 64 * 64; ++i)
    ramp.texels.emplace_back(static_cast<double>(i % 64) / 64.0, static_cast<double>(i / 64) / 64.0, 0.5);
  const PrefilteredTexture texture = prefilter(ramp, {});
  int checked = 0;
  for (std::size_t level = 0; level < 4; ++level) {
    const std::size_t size = texture.levels[level].size;
    for (std::size_t y = 0; y < size; ++y) {
      for (std::size_t x = 0; x < size; ++x) {
        const Vector2d p = coordinates(texture, level, x, y);
        const double reach = 6.0 * sigmaOfLevel(texture, level) + 1.0 / 64.0;
        if (p.minCoeff() < reach || p.maxCoeff() > 1.0 - reach) continue;
        const Vector3d expected(p.x() - 0.5 / 64.0, p.y() - 0.5 / 64.0, 0.5);
        EXPECT_LE((texture.levels[level].texels[y * size + x] - expected).cwiseAbs().maxCoeff(), 1e-7);
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 1000);
}

TEST(Prefilter, MirroredPictureMirroredTexture) {
  const LightTexture picture = noise(12, 20);
  LightTexture turned = picture;
  std::reverse(turned.texels.begin(), turned.texels.end());
  const PrefilteredTexture a = prefilter(picture, {});
  const PrefilteredTexture b = prefilter(turned, {});
  for (std::size_t l = 0; l < a.levels.size(); ++l) {
    const std::size_t n = a.levels[l].texels.size();
    // what is cut off at 6 sigmas may differ by a texel
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_LE((a.levels[l].texels[i] - b.levels[l].texels[n - 1 - i]).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(Prefilter, SameBitsForAnyThreads) {
  const LightTexture picture = noise(40, 40);
  PrefilterOptions options;
  options.threads = 1;
  const PrefilteredTexture one = prefilter(picture, options);
  options.threads = 3;
  const PrefilteredTexture three = prefilter(picture, options);
  for (std::size_t l = 0; l < one.levels.size(); ++l) EXPECT_EQ(one.levels[l].texels, three.levels[l].texels);
}

TEST(Prefilter, LodAndSigmaAreInverse) {
  const PrefilteredTexture texture = prefilter(noise(16, 16), {});
  for (double lod = -3.0; lod < 12.0; lod += 0.37)
    EXPECT_NEAR(lodOfSigma(texture, sigmaOfLod(texture, lod)), lod, 1e-12);
  EXPECT_LT(lodOfSigma(texture, 0.1), lodOfSigma(texture, 0.11));
}

TEST(Prefilter, TrilinearLookUpIsTheGaussianOfItsSigma) {
  const LightTexture picture = stainedGlass(64, 3);
  const PrefilteredTexture texture = prefilter(picture, {});
  // at lods between and at levels; a lod that is half a level off must be clearly worse
  Random random(2);
  double error = 0.0;
  double below = 0.0;
  double above = 0.0;
  for (int i = 0; i < 60; ++i) {
    const Vector2d uv(random.uniform(), random.uniform());
    const double lod = 0.5 + 4.0 * random.uniform();
    const double sigma = sigmaOfLod(texture, lod);
    const Vector3d expected = bruteForce(picture, uv, sigma, sigma, 400);
    error += (sampleTrilinear(texture, uv, lod) - expected).squaredNorm();
    below += (sampleTrilinear(texture, uv, lod - 0.5) - expected).squaredNorm();
    above += (sampleTrilinear(texture, uv, lod + 0.5) - expected).squaredNorm();
  }
  EXPECT_LT(std::sqrt(error / 180.0), 0.02);  // of colours up to 1
  EXPECT_GT(below, 4.0 * error);
  EXPECT_GT(above, 4.0 * error);
}

TEST(Prefilter, OptionsOutOfRange) {
  const LightTexture picture = noise(4, 4);
  const auto refused = [&](const auto& change) {
    PrefilterOptions options;
    change(options);
    EXPECT_THROW(prefilter(picture, options), std::invalid_argument);
  };
  refused([](auto& o) { o.margin = -0.1; });
  refused([](auto& o) { o.margin = std::nan(""); });
  refused([](auto& o) { o.aspect = 0.0; });
  refused([](auto& o) { o.spread = 0.0; });
  refused([](auto& o) { o.size = 48; });
  refused([](auto& o) { o.size = 8192; });
  EXPECT_THROW(prefilter({"", 0, 0, {}}, {}), std::invalid_argument);
  EXPECT_THROW(prefilter({"", 2, 2, {Vector3d::Zero()}}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace ltcfit
