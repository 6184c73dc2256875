// The polynomials of data/ltc_iso.cheb.* in shaders, against the form in double, and what they cost.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <fstream>
#include <numbers>

#include "export/atomic_file.h"
#include "export/chebyshev_file.h"
#include "render/shader_cost.h"
#include "render/shader_text.h"
#include "tests/render/shader.h"
#include "tests/render/tables.h"

namespace ltcfit {
namespace {

using test::displacement;
using test::raise;
using test::Shader;
using test::ShaderEntry;

std::string dataFile(const std::string& name) {
  return readFile(std::string(LTCFIT_DATA_DIR) + "/" + name);
}

const ChebyshevForm& form() {
  static const ChebyshevForm read = chebyshevFromJson(dataFile("ltc_iso.cheb.json"), "ltc_iso.cheb.json");
  return read;
}

class ChebyshevShader : public testing::TestWithParam<const Shader*> {};

struct Worst {
  double matrix = 0.0, norm = 0.0, fresnel = 0.0;
};

// From the floor to roughness 1 and from normal to grazing view, both ends included.
template <class Fetch>
Worst worstOf(const Fetch& fetch) {
  Worst worst;
  constexpr int kSteps = 40;
  for (int i = 0; i <= kSteps; ++i) {
    const float roughness = 0.01f + 0.99f * static_cast<float>(i) / kSteps;
    for (int j = 0; j <= kSteps; ++j) {
      // what the shader is given, in its own precision
      const float u = static_cast<float>(j) / kSteps;
      const float nDotV = 1.0f - u * u;
      const double alpha = static_cast<double>(roughness) * static_cast<double>(roughness);
      const double theta = nDotV > 0.0f ? std::acos(static_cast<double>(nDotV)) : 0.5 * std::numbers::pi;
      const TableEntry expected = form().evaluate({alpha, alpha, theta, 0.0});
      const ShaderEntry found = fetch(roughness, nDotV);
      raise(worst.matrix, displacement(found.inverse, expected.m));
      raise(worst.norm, std::abs(static_cast<double>(found.norm) - *expected.norm));
      raise(worst.fresnel, std::abs(static_cast<double>(found.fresnel) - *expected.fresnel));
    }
  }
  return worst;
}

// Float32: sums of some 40 terms up to 3, and a direction that is off by 1e-7 of lobes of width 2e-4.
constexpr double kDisplacement = 2e-3;
constexpr double kAmplitude = 2e-6;

TEST_P(ChebyshevShader, IsTheForm) {
  const Worst worst = worstOf(GetParam()->polynomials);
  EXPECT_LT(worst.matrix, kDisplacement);
  EXPECT_LT(worst.norm, kAmplitude);
  EXPECT_LT(worst.fresnel, kAmplitude);
}

TEST_P(ChebyshevShader, IsTheFormOfOneRoughnessToo) {
  const auto rows = static_cast<std::size_t>(GetParam()->rows);
  const Worst worst = worstOf([&](float roughness, float nDotV) {
    std::vector<std::array<float, 4>> shape(rows);
    std::vector<std::array<float, 2>> amplitude(rows);
    const double x = 2.0 * static_cast<double>(roughness) - 1.0;
    for (std::size_t f = 0; f < kChebyshevFunctions; ++f) {
      for (std::size_t j = 0; j < form().functions[f].size(); ++j) {
        double sum = 0.0;
        const std::vector<double>& row = form().functions[f][j];
        for (std::size_t i = 0; i < row.size(); ++i)
          sum += row[i] * std::cos(static_cast<double>(i) * std::acos(x));
        (f < 4 ? shape[j][f] : amplitude[j][f - 4]) = static_cast<float>(sum);
      }
    }
    return GetParam()->collapsed(shape, amplitude, roughness, nDotV);
  });
  EXPECT_LT(worst.matrix, kDisplacement);
  EXPECT_LT(worst.norm, kAmplitude);
  EXPECT_LT(worst.fresnel, kAmplitude);
}

TEST_P(ChebyshevShader, OutsideOfItsRangeItIsClamped) {
  for (const auto& [asked, clamped] : {std::pair{0.0f, 0.01f}, {-1.0f, 0.01f}, {2.0f, 1.0f}})
    EXPECT_EQ(GetParam()->polynomials(asked, 0.5f).inverse, GetParam()->polynomials(clamped, 0.5f).inverse);
  EXPECT_EQ(GetParam()->polynomials(0.3f, -0.5f).inverse, GetParam()->polynomials(0.3f, 0.0f).inverse);
  EXPECT_EQ(GetParam()->polynomials(0.3f, 1.0001f).inverse, GetParam()->polynomials(0.3f, 1.0f).inverse);
}

INSTANTIATE_TEST_SUITE_P(Languages, ChebyshevShader, testing::Values(&test::kGlsl, &test::kHlsl),
                         [](const auto& test) { return test.param->name; });

ShaderCost costOf(const std::string& lookUp) {
  return shaderCost(
      "#version 450\n" + std::string(shaderText("ltc.glsl")) + dataFile("ltc_iso.cheb.glsl") +
      "uniform vec4 shape[ltc_iso_rows];\nuniform vec2 amplitude[ltc_iso_rows];\n"
      "uniform float roughness;\nuniform sampler2D matrixTable;\nuniform sampler2D amplitudeTable;\n"
      "in float nDotV;\nout vec4 a;\nout vec4 b;\nvoid main() {\n  LtcEntry e = " +
      lookUp +
      ";\n  a = vec4(e.inverse[0].xz, e.inverse[2].xz);\n"
      "  b = vec4(e.norm, e.fresnel, 0.0, 0.0);\n}\n");
}

// As README counts them.
TEST(ChebyshevShaderCost, IsThatOfItsCoefficients) {
  const ShaderCost all = costOf("ltc_iso_fetch(roughness, nDotV)");
  const ShaderCost collapsed = costOf("ltc_iso_fetchCollapsed(shape, amplitude, roughness, nDotV)");
  const ShaderCost texture = costOf("ltcFetch(matrixTable, amplitudeTable, roughness, nDotV)");
  EXPECT_EQ(all.fetches, 0);
  EXPECT_EQ(collapsed.fetches, 0);
  EXPECT_EQ(texture.fetches, 2);
  // a fused product and sum for each coefficient, and less than half as much for all the rest
  EXPECT_GT(all.total(), 160);
  EXPECT_LT(all.total(), 300);
  EXPECT_LT(collapsed.total(), 160);
  RecordProperty("polynomials", std::to_string(all.total()));
  RecordProperty("collapsed", std::to_string(collapsed.total()));
  RecordProperty("textures", std::to_string(texture.total()));
}

}  // namespace
}  // namespace ltcfit
