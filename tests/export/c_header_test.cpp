#include "export/c_header.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tests/support/small_table.h"

namespace ltcfit {
namespace {

// Compiles the header as C and lets a C program print its numbers: a reader that we did not write.
std::vector<float> readByCompiler(const std::string& header, const std::string& name, int components) {
  char folderName[] = "/tmp/ltcfit-test-XXXXXX";
  const std::filesystem::path folder = ::mkdtemp(folderName);
  std::ofstream(folder / "t.h") << header;
  std::ofstream(folder / "t.c")
      << "#include \"t.h\"\n#include \"t.h\"\n#include <stdio.h>\nint main(void) {\n"
      << "  int i, k;\n  for (i = 0; i < t_width * t_height; ++i)\n    for (k = 0; k < " << components
      << "; ++k) printf(\"%.9g\\n\", " << name << "[i][k]);\n  return 0;\n}\n";
  const std::string command = std::string(LTCFIT_C_COMPILER) +
                              " -x c -std=c99 -Wall -Wextra -Werror -Wno-unused " +
                              (folder / "t.c").string() + " -o " + (folder / "t").string();
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::vector<float> out;
  if (std::FILE* pipe = ::popen((folder / "t").c_str(), "r")) {
    float v = 0.0f;
    while (std::fscanf(pipe, "%f", &v) == 1) out.push_back(v);
    ::pclose(pipe);
  }
  std::filesystem::remove_all(folder);
  return out;
}

TEST(CHeader, ACompilerReadsTheTable) {
  const Table table = test::smallTable();
  const std::string header = tableToCHeader(table, "t");
  const std::vector<float> matrix = readByCompiler(header, "t_matrix", 4);
  const std::vector<float> amplitude = readByCompiler(header, "t_amplitude", 2);
  ASSERT_EQ(matrix.size(), 48u);
  ASSERT_EQ(amplitude.size(), 24u);
  for (std::size_t i = 0; i < 12; ++i) {
    const TableEntry e = table.entry(table.node(i));
    const double d = e.mInv(1, 1);
    // the float32 nearest to the double, through text and back
    EXPECT_EQ(matrix[4 * i + 0], static_cast<float>(e.mInv(0, 0) / d));
    EXPECT_EQ(matrix[4 * i + 1], static_cast<float>(e.mInv(2, 0) / d));
    EXPECT_EQ(matrix[4 * i + 2], static_cast<float>(e.mInv(0, 2) / d));
    EXPECT_EQ(matrix[4 * i + 3], static_cast<float>(e.mInv(2, 2) / d));
    EXPECT_EQ(amplitude[2 * i + 0], static_cast<float>(*e.norm));
    EXPECT_EQ(amplitude[2 * i + 1], static_cast<float>(*e.fresnel));
  }
}

TEST(CHeader, SaysWhatItIs) {
  const std::string header = tableToCHeader(test::smallTable(), "t");
  for (const char* part :
       {"ltcfit fit iso --size 3x4", "1.2.3", "sqrt(alpha)", "sqrt(1 - N.V)", "4x3 texels", "row-major",
        "Minv00, Minv20, Minv02, Minv22", "alpha floor: 0.0001", "leans to -x"}) {
    EXPECT_NE(header.find(part), std::string::npos) << part;
  }
}

TEST(CHeader, TextOfTheFileCannotLeaveTheComment) {
  TableInfo info = test::smallTable().info();
  info.provenance.command = "x */ int evil; /* \n #error y";
  const std::string header = tableToCHeader(Table(info, test::smallTable().data()), "a-b 1");
  EXPECT_EQ(header.find("*/"), header.find("*/\n#ifndef A_B_1_H"));
  EXPECT_EQ(header.find("\n #error"), std::string::npos);
}

TEST(CHeader, RefusesWhatHasNoPlaceInIt) {
  TableInfo info = test::smallTable().info();
  info.channels[1] = "m01";
  EXPECT_THROW(tableToCHeader(Table(info, test::smallTable().data()), "t"), std::invalid_argument);
  std::vector<float> singular = test::smallTable().data();
  singular[2] = 0.0f;  // m11 of the first node
  EXPECT_THROW(tableToCHeader(Table(test::smallTable().info(), singular), "t"), std::invalid_argument);
}

}  // namespace
}  // namespace ltcfit
