// The generated look-ups of single tables, as C++, against Table::fetch in double.
#include "export/shader_lookup.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "export/texture_files.h"
#include "tests/render/tables.h"
#include "tests/support/tailored.h"

namespace ltcfit::test {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

struct LeanTextures {
  Texture matrix;  // or the volume
  Texture amplitude;
};

Texture toTexture(const Image& image) {
  Texture texture;
  texture.width = static_cast<int>(image.width);
  texture.height = static_cast<int>(image.height);
  texture.depth = static_cast<int>(image.depth);
  texture.texels.resize(image.texels());
  for (std::size_t i = 0; i < image.values.size(); ++i)
    texture.texels[i / image.components][i % image.components] = image.values[i];
  return texture;
}

LeanTextures leanTextures(const Table& table, Precision precision = Precision::kFloat) {
  const PackedTable packed = pack(table, packingLean(table.info()), precision);
  if (!table.isIsotropic()) return {toTexture(stackedImage(packed)), {}};
  return {toTexture(packed.images[0]), packed.images.size() > 1 ? toTexture(packed.images[1]) : Texture()};
}

TableEntry expected(const Table& table, const LookupArguments& a) {
  if (table.isIsotropic()) {
    const double alpha = static_cast<double>(a.roughness) * static_cast<double>(a.roughness);
    return table.fetch({alpha, alpha, std::acos(static_cast<double>(a.nDotV)), 0.0});
  }
  const Eigen::Vector3d v = toEigen(a.view);
  return table.fetch({static_cast<double>(a.alphaX), static_cast<double>(a.alphaY),
                      std::atan2(std::hypot(v.x(), v.y()), v.z()), std::atan2(v.y(), v.x())});
}

class ShaderLookupTest : public testing::TestWithParam<Shader> {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  const Lookup& lookup(const std::string& name) const {
    for (const Lookup& l : GetParam().lookups)
      if (l.name == name) return l;
    throw std::logic_error(name);
  }
  Vec3 direction(double theta, double phi) const {
    return toVec3(
        Eigen::Vector3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
  }
  // Any lobe, a quarter of them sharp ones or views at an end, most tables' axes left on both sides.
  LookupArguments random(int i) {
    LookupArguments a;
    const auto alpha = [&] {
      return static_cast<float>(i % 4 == 0 ? std::pow(10.0, uniform(-4.0, 0.0)) : uniform(0.0, 1.0));
    };
    a.roughness = static_cast<float>(uniform(0.0, 1.0));
    a.nDotV = static_cast<float>(uniform(0.0, i % 5 == 0 ? 0.01 : 1.0));
    a.alphaX = alpha();
    a.alphaY = alpha();
    a.view = direction(uniform(0.0, i % 7 == 0 ? 0.01 : kHalfPi), uniform(0.0, 4.0 * kHalfPi));
    return a;
  }

 private:
  std::mt19937 random_{1};
};
INSTANTIATE_TEST_SUITE_P(Languages, ShaderLookupTest, testing::Values(kGlsl, kHlsl),
                         [](const auto& instance) { return instance.param.name; });

// Largest error of the matrix, as displacement over condition, and of norm and fresnel.
struct Worst {
  double matrix = 0.0;
  double amplitude = 0.0;

  void add(const ShaderEntry& is, const TableEntry& should) {
    raise(matrix, displacement(is.inverse, should.m) / (should.m.norm() * should.mInv.norm()));
    raise(amplitude, std::abs(static_cast<double>(is.norm) - should.norm.value_or(1.0)));
    raise(amplitude, std::abs(static_cast<double>(is.fresnel) - should.fresnel.value_or(0.0)));
  }
};

// those of ShaderFetch, for the same reason: float32 coordinates, those of slices more than others
double bound(const Table& table) {
  return table.isIsotropic() ? 1e-6 : 4e-6;
}

TEST_P(ShaderLookupTest, IsTheTablesOwnLookUp) {
  for (const Tailored& t : tailoredTables()) {
    const LeanTextures textures = leanTextures(t.table);
    Worst worst;
    for (int i = 0; i < 20000; ++i) {
      const LookupArguments a = random(i);
      worst.add(lookup(t.name).fetch(textures.matrix, textures.amplitude, a), expected(t.table, a));
    }
    std::printf("  %-16s %.1e, norm and fresnel %.1e\n", t.name.c_str(), worst.matrix, worst.amplitude);
    EXPECT_LT(worst.matrix, bound(t.table)) << t.name;
    EXPECT_LT(worst.amplitude, 2.5 * bound(t.table)) << t.name;
  }
}

TEST_P(ShaderLookupTest, AWrongWarpIsSeen) {
  const Table& table = tailoredTable("isoRange");
  const LeanTextures textures = leanTextures(table);
  Worst worst;
  for (int i = 0; i < 200; ++i) {
    const LookupArguments a = random(i);
    worst.add(lookup("wrongWarp").fetch(textures.matrix, textures.amplitude, a), expected(table, a));
  }
  EXPECT_GT(worst.matrix, 100.0 * bound(table));
}

TEST_P(ShaderLookupTest, OfAFullTableIsThatOfAll) {
  const LeanTextures iso = leanTextures(tailoredTable("isoFull"));
  const LeanTextures aniso = leanTextures(tailoredTable("anisoFull"));
  for (int i = 0; i < 2000; ++i) {
    const LookupArguments a = random(i);
    const auto expectSame = [&](const ShaderEntry& one, const ShaderEntry& two, double slack) {
      EXPECT_NEAR(one.norm, two.norm, slack);
      EXPECT_NEAR(one.fresnel, two.fresnel, slack);
      const double size = toEigen(two.inverse).cwiseAbs().maxCoeff();
      EXPECT_LT((toEigen(one.inverse) - toEigen(two.inverse)).cwiseAbs().maxCoeff(), slack * size);
    };
    expectSame(lookup("isoFull").fetch(iso.matrix, iso.amplitude, a),
               GetParam().fetch(iso.matrix, iso.amplitude, a.roughness, a.nDotV), 1e-5);
    // twice the bound of one, times the condition
    const double condition = expected(tailoredTable("anisoFull"), a).m.norm() *
                             expected(tailoredTable("anisoFull"), a).mInv.norm();
    expectSame(lookup("anisoFull").fetch(aniso.matrix, aniso.amplitude, a),
               GetParam().fetchAnisotropic(aniso.matrix, 8, 8, a.alphaX, a.alphaY, a.view), 2e-5 * condition);
  }
}

TEST_P(ShaderLookupTest, HalvesHaveAScaleThatNoLobeFeels) {
  for (const char* name : {"isoRange", "anisoRange", "anisoFull"}) {
    const Table& table = tailoredTable(name);
    const LeanTextures textures = leanTextures(table, Precision::kHalf);
    const Table rounded = unpack(pack(table, packingLean(table.info()), Precision::kHalf));
    Worst worst;
    for (int i = 0; i < 2000; ++i) {
      const LookupArguments a = random(i);
      worst.add(lookup(name).fetch(textures.matrix, textures.amplitude, a), expected(rounded, a));
    }
    EXPECT_LT(worst.matrix, bound(table)) << name;
  }
}

// As of ShaderFetch: what lies in the slices of other rows and alphas is so large that the least of it shows.
TEST_P(ShaderLookupTest, SlicesDoNotBleed) {
  for (const char* name : {"anisoFull", "anisoRange", "anisoOneAlpha", "anisoOneLambda"}) {
    const std::vector<Axis>& axes = tailoredTable(name).info().axes;
    const int alphas = static_cast<int>(axes[0].size());
    const int lambdas = static_cast<int>(axes[1].size());
    const bool blocks = lambdas > 1 && alphas > 1;
    for (int a = 0; a == 0 || (blocks && a + 1 < alphas); ++a) {
      for (double lambda : {axes[1].values.front(), axes[1].values.back()}) {
        for (double alpha : blocks ? std::vector{axes[0].valueFromTexel(a + 0.5)}
                                   : std::vector{axes[0].values.front(), axes[0].values.back()}) {
          for (int row = 0; row < 3; ++row) {
            Texture texture;
            texture.width = static_cast<int>(axes[3].size());
            texture.height = static_cast<int>(axes[2].size());
            texture.depth = 3 * alphas * lambdas;
            // two of the rows, the third is what must not be seen in them
            for (int slice = 0; slice < texture.depth; ++slice) {
              const int own = slice / (alphas * lambdas);
              const int at = slice / lambdas % alphas;
              std::array<float, 4> texel{0.0f, 0.0f, 0.0f, 0.5f};
              texel[static_cast<std::size_t>(own)] = 1.0f;
              if (blocks && at != a && at != a + 1) texel.fill(1e20f);
              if (own == row) texel[static_cast<std::size_t>((own + 1) % 3)] = 1e20f;
              texture.texels.insert(texture.texels.end(),
                                    static_cast<std::size_t>(texture.width * texture.height), texel);
            }
            LookupArguments arguments;
            arguments.alphaX = static_cast<float>(alpha);
            arguments.alphaY = static_cast<float>(alpha * lambda);
            arguments.view = {0.3f, 0.2f, 0.9f};
            const ShaderEntry e = lookup(name).fetch(texture, texture, arguments);
            // Rows e_i and one of them plus 1e20 of its follower: the inverse is the unit matrix less that.
            Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
            m(row, (row + 1) % 3) = 1e20;
            const Eigen::Matrix3d inverse = m.inverse() / m.inverse().cwiseAbs().maxCoeff();
            EXPECT_LT((toEigen(e.inverse) - inverse).cwiseAbs().maxCoeff(), 1e-5) << name << ' ' << row;
          }
        }
      }
    }
  }
}

TEST_P(ShaderLookupTest, IsFiniteForEveryFiniteArgument) {
  const std::vector<float> alphas{-1.0f, 0.0f, 1e-45f, 1e-39f, 1e-20f, 0.5f, 1.0f, 2.0f, 1e30f};
  const std::vector<float> parts{-1e18f, -1.0f, -1e-20f, -0.0f, 0.0f, 1e-45f, 1e-30f, 1e-7f, 1.0f, 1e18f};
  for (const Tailored& t : tailoredTables()) {
    const LeanTextures textures = leanTextures(t.table);
    const auto expectFinite = [&](const LookupArguments& a) {
      const ShaderEntry e = lookup(t.name).fetch(textures.matrix, textures.amplitude, a);
      ASSERT_TRUE(toEigen(e.inverse).allFinite() && std::isfinite(e.norm) && std::isfinite(e.fresnel))
          << t.name << ' ' << a.alphaX << ' ' << a.alphaY << ' ' << a.view[0] << ' ' << a.view[1] << ' '
          << a.view[2] << ' ' << a.roughness << ' ' << a.nDotV;
    };
    for (float x : alphas) {
      for (float y : alphas) {
        LookupArguments a;
        a.roughness = x;
        a.nDotV = y < 2.0f ? y : -y;
        a.alphaX = x;
        a.alphaY = y;
        if (t.table.isIsotropic()) {
          expectFinite(a);
          continue;
        }
        for (float vx : parts) {
          for (float vy : parts) {
            for (float vz : parts) {
              a.view = {vx, vy, vz};
              expectFinite(a);
            }
          }
        }
      }
    }
  }
}

TEST(ShaderLookup, TakesWhatItNeeds) {
  using Names = std::vector<std::string>;
  const auto parametersOf = [](const char* name, ShadingLanguage language) {
    return makeShaderLookup(tailoredTable(name).info(), language, "x").parameters;
  };
  constexpr ShadingLanguage kGlslLanguage = ShadingLanguage::kGlsl;
  EXPECT_EQ(parametersOf("isoRange", kGlslLanguage),
            (Names{"matrixTable", "amplitudeTable", "roughness", "nDotV"}));
  EXPECT_EQ(parametersOf("isoRow", kGlslLanguage), (Names{"matrixTable", "amplitudeTable", "nDotV"}));
  EXPECT_EQ(parametersOf("isoLinear", kGlslLanguage), (Names{"matrixTable", "roughness", "nDotV"}));
  EXPECT_EQ(parametersOf("isoNode", kGlslLanguage), (Names{"matrixTable", "amplitudeTable"}));
  EXPECT_EQ(parametersOf("isoLinear", ShadingLanguage::kHlsl),
            (Names{"matrixTable", "bilinear", "roughness", "nDotV"}));
  EXPECT_EQ(parametersOf("anisoTheta", kGlslLanguage), (Names{"table", "alphaX", "alphaY", "view"}));
  for (const auto& [name, fetches] : {std::pair{"isoRange", 2},
                                      {"isoLinear", 1},
                                      {"anisoRange", 6},
                                      {"anisoOneAlpha", 3},
                                      {"anisoOneLambda", 3},
                                      {"anisoTheta", 3}})
    EXPECT_EQ(fetchesOf(tailoredTable(name).info()), fetches) << name;
}

TEST(ShaderLookup, LeavesOutWhatATableLacks) {
  const auto sourceOf = [](const char* name) {
    return makeShaderLookup(tailoredTable(name).info(), ShadingLanguage::kGlsl, "x y").source;
  };
  const auto has = [](const std::string& text, const char* what) {
    return text.find(what) != std::string::npos;
  };
  EXPECT_TRUE(has(sourceOf("anisoFull"), "LtcEntry x_yFetchAnisotropic("));
  for (const char* name : {"anisoFull", "anisoRange", "anisoOneAlpha", "anisoOneLambda", "anisoTheta"})
    EXPECT_FALSE(has(sourceOf(name), "textureSize")) << name;
  EXPECT_TRUE(has(sourceOf("anisoFull"), "ltcRow(") && has(sourceOf("anisoFull"), "lambda = "));
  EXPECT_FALSE(has(sourceOf("anisoOneAlpha"), "ltcRow("));
  EXPECT_FALSE(has(sourceOf("anisoOneLambda"), "ltcRow(") || has(sourceOf("anisoOneLambda"), "lambda = "));
  EXPECT_FALSE(has(sourceOf("anisoTheta"), "phi = ") || has(sourceOf("anisoTheta"), "clamp("));
  EXPECT_TRUE(has(sourceOf("isoRow"), "entry.fresnel = 0.0;") && has(sourceOf("isoRow"), "R: norm\n"));
}

TEST(ShaderLookup, RefusesAxesThatAShaderWouldSearch) {
  TableInfo info = tailoredTable("isoRange").info();
  info.axes[1].map = AxisMap::kNone;
  info.axes[1].warp = {};
  try {
    makeShaderLookup(info, ShadingLanguage::kGlsl, "x");
    ADD_FAILURE() << "no error";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("axis 'alpha'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace ltcfit::test
