// The decoders in C and JavaScript, run by a compiler and by node, against the form itself. Those for shaders
// are in tests/render/chebyshev_shader_test.cpp.
#include "export/chebyshev_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "export/chebyshev_file.h"
#include "export/formats.h"
#include "export/read_table.h"

namespace ltcfit {
namespace {

constexpr std::size_t kWidth = 9;
constexpr std::size_t kHeight = 12;

class ChebyshevSource : public testing::Test {
 protected:
  void SetUp() override {
    char name[] = "/tmp/ltcfit-test-XXXXXX";
    folder_ = ::mkdtemp(name);
    FormatOptions options;
    options.prefix = "t";
    const Table table = readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_iso.json");
    const ExportResult result = exportTable(table, *findFormat("chebyshev"), options, "t");
    form_ = chebyshevFromJson(result.files[0].bytes, "t");
    for (const ExportFile& file : result.files) std::ofstream(folder_ / file.name) << file.bytes;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::vector<float> outputOf(const std::string& command) {
    std::vector<float> out;
    if (std::FILE* pipe = ::popen(command.c_str(), "r")) {
      float v = 0.0f;
      while (std::fscanf(pipe, "%f", &v) == 1) out.push_back(v);
      EXPECT_EQ(::pclose(pipe), 0) << command;
    }
    return out;
  }

  // Both textures in the layout of 2017, one after the other, against the form in double.
  void expectTextures(const std::vector<float>& numbers) {
    ASSERT_EQ(numbers.size(), 2 * 4 * kWidth * kHeight);
    for (std::size_t y = 0; y < kHeight; ++y) {
      for (std::size_t x = 0; x < kWidth; ++x) {
        const double root = static_cast<double>(x) / (kWidth - 1);
        const double u = static_cast<double>(y) / (kHeight - 1);
        const double theta = y + 1 == kHeight ? 0.5 * std::numbers::pi : std::acos(1.0 - u * u);
        const TableEntry e = form_.evaluate({root * root, root * root, theta, 0.0});
        const Eigen::Matrix3d inverse = e.mInv / e.mInv(1, 1);
        const float* t1 = &numbers[4 * (y * kWidth + x)];
        const float* t2 = t1 + 4 * kWidth * kHeight;
        const double expected[] = {inverse(0, 0), inverse(2, 0), inverse(0, 2), inverse(2, 2)};
        // float32 sums of some 40 terms up to 3: 2e-7 of them, and what cos(theta) loses near 90 degrees
        for (int k = 0; k < 4; ++k)
          EXPECT_NEAR(t1[k], expected[k], 2e-5 * std::abs(expected[k]) + 2e-7) << x << " " << y << " " << k;
        EXPECT_NEAR(t2[0], *e.norm, 1e-6);
        EXPECT_NEAR(t2[1], *e.fresnel, 1e-6);
        EXPECT_EQ(t2[2], 0.0f);
        EXPECT_EQ(t2[3], 0.0f);
      }
    }
  }

  std::filesystem::path folder_;
  ChebyshevForm form_;
};

TEST_F(ChebyshevSource, ACompilerRunsTheHeader) {
  std::ofstream(folder_ / "t.c")
      << "#include \"t.cheb.h\"\n#include \"t.cheb.h\"\n#include <stdio.h>\n"
      << "enum { W = " << kWidth << ", H = " << kHeight << " };\nstatic float a[4 * W * H], b[4 * W * H];\n"
      << "int main(void) {\n  int i;\n  t_fill(a, b, W, H);\n"
      << "  for (i = 0; i < 4 * W * H; ++i) printf(\"%.9g\\n\", a[i]);\n"
      << "  for (i = 0; i < 4 * W * H; ++i) printf(\"%.9g\\n\", b[i]);\n  return 0;\n}\n";
  for (const char* language : {"c -std=c99", "c++ -std=c++11"}) {
    const std::string program = (folder_ / "t").string();
    const std::string command = std::string(LTCFIT_C_COMPILER) + " -x " + language +
                                " -Wall -Wextra -Wconversion -Werror " + (folder_ / "t.c").string() + " -o " +
                                program + " -lm";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    expectTextures(outputOf(program));
  }
}

TEST_F(ChebyshevSource, NodeRunsTheModule) {
  if (std::system("node --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no node";
  std::filesystem::rename(folder_ / "t.cheb.js", folder_ / "t.mjs");
  std::ofstream(folder_ / "run.mjs")
      << "import { textures, collapse, texel, rows } from './t.mjs';\n"
      << "const both = textures(" << kWidth << ", " << kHeight << ");\n"
      << "for (const t of both) for (const v of t) console.log(v);\n"
      << "const c = collapse(0.5);\n"
      << "if (c.shape.length !== 4 * rows || c.amplitude.length !== 2 * rows)\n"
      << "  process.exit(1);\n"
      << "const e = texel(c, 0);\n"
      << "if (!(e.norm === 1)) process.exit(1);\n";
  expectTextures(outputOf("node " + (folder_ / "run.mjs").string()));
}

TEST_F(ChebyshevSource, SaysWhatItIs) {
  for (const char* file : {"t.cheb.glsl", "t.cheb.hlsl", "t.cheb.h", "t.cheb.js"}) {
    std::ifstream in(folder_ / file);
    const std::string text((std::istreambuf_iterator<char>(in)), {});
    for (const char* part : {"ltcfit fit iso", "160 coefficients, 320 bytes", "alpha 0.0001", "leans to -x"})
      EXPECT_NE(text.find(part), std::string::npos) << file << ": " << part;
  }
}

TEST_F(ChebyshevSource, TextOfTheFileCannotLeaveTheComment) {
  form_.provenance.command = "x */ int evil; /* \n#error y";
  const std::string header = chebyshevToCHeader(form_, {}, "t");
  EXPECT_EQ(header.find("*/"), header.find("*/\n#ifndef T_CHEBYSHEV_H"));
  EXPECT_EQ(header.find("\n#error"), std::string::npos);
  EXPECT_EQ(chebyshevToShader(form_, {}, "t", ShadingLanguage::kGlsl).find("\n#error"), std::string::npos);
  EXPECT_EQ(chebyshevToModule(form_, {}).find("\n#error"), std::string::npos);
}

}  // namespace
}  // namespace ltcfit
