#include "export/chebyshev_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "export/atomic_file.h"
#include "export/formats.h"
#include "export/json_table.h"
#include "export/read_table.h"

namespace ltcfit {
namespace {

Table defaultTable() {
  return readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_iso.json");
}

ExportResult exported(std::size_t bytes) {
  FormatOptions options;
  options.coefficientBytes = bytes;
  return exportTable(defaultTable(), *findFormat("chebyshev"), options, "t.cheb.json");
}

std::string messageOf(const std::string& text) {
  try {
    chebyshevFromJson(text, "F");
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

TEST(ChebyshevFile, ReadsBackToTheSameForm) {
  const ExportResult result = exported(FormatOptions().coefficientBytes);
  ASSERT_EQ(result.files.size(), 5u);
  EXPECT_EQ(result.files[0].name, "t.cheb.json");
  EXPECT_EQ(result.files[4].name, "t.cheb.js");
  const ChebyshevForm form = chebyshevFromJson(result.files[0].bytes, "F");
  EXPECT_EQ(form.coefficients() * kCoefficientBytes, FormatOptions().coefficientBytes);
  EXPECT_EQ(form.provenance.command, defaultTable().info().provenance.command);
  for (const ChebyshevRows& function : form.functions)
    for (const auto& row : function)
      for (const double c : row) EXPECT_EQ(c, roundToHalfPrecision(c));
  EXPECT_EQ(chebyshevToJson(form, *result.chebyshev), result.files[0].bytes);
  EXPECT_EQ(tableOfChebyshev(form).data(), result.table->data());
}

TEST(ChebyshevFile, IsATableToEveryCommand) {
  const ExportResult result = exported(320);
  const std::string path = testing::TempDir() + "/ltcfit_chebyshev.json";
  std::ofstream(path) << result.files[0].bytes;
  const TableFile file = readTableFile(path);
  std::filesystem::remove(path);
  EXPECT_EQ(file.format, "Chebyshev form");
  EXPECT_EQ(file.table.data(), result.table->data());
}

// What README states of the default; report_test has its errors against the lobes.
TEST(ChebyshevFile, DefaultIsCloseToItsTable) {
  const ChebyshevDifference d = *exported(FormatOptions().coefficientBytes).chebyshev;
  EXPECT_LT(d.meanShift, 0.004);
  EXPECT_LT(d.largestShift, 0.15);
  EXPECT_LT(d.meanNorm, 5e-4);
  EXPECT_LT(d.largestNorm, 0.012);
  EXPECT_LT(d.meanFresnel, 5e-4);
  EXPECT_LT(d.largestFresnel, 0.012);
}

TEST(ChebyshevFile, MoreBytesAreNoWorse) {
  double shift = 1.0;
  double norm = 1.0;
  for (const std::size_t bytes : {128u, 192u, 320u, 512u}) {
    const ChebyshevDifference d = *exported(bytes).chebyshev;
    EXPECT_LT(d.meanShift, shift) << bytes;
    EXPECT_LE(d.meanNorm, norm) << bytes;
    shift = d.meanShift;
    norm = d.meanNorm;
  }
}

// Between the nodes of the resampled table, lobes are those of the form.
TEST(ChebyshevFile, ResampledLobesAreThoseOfTheForm) {
  const ChebyshevForm form = chebyshevFromJson(exported(320).files[0].bytes, "F");
  const Table table = tableOfChebyshev(form);
  // The middle of cells, up to 75 degrees: nearer to grazing view the table of sharp lobes is curved whatever
  // it was made of. The diagonal of M is of the order of alpha, and so is the shift that a lobe feels.
  for (double y = 0.5; y < 220.0; y += 7.0) {
    for (double x = 12.5; x < 256.0; x += 7.0) {
      const double alpha = table.info().axes[1].valueFromTexel(x);
      const double theta = table.info().axes[0].valueFromTexel(y);
      const LobeParameters p{alpha, alpha, theta, 0.0};
      const TableEntry expected = form.evaluate(p);
      const TableEntry fetched = table.fetch(p);
      EXPECT_LT((fetched.m - expected.m).cwiseAbs().maxCoeff(), 0.01 * alpha) << alpha << " " << theta;
      EXPECT_NEAR(*fetched.norm, *expected.norm, 1e-3);
      EXPECT_NEAR(*fetched.fresnel, *expected.fresnel, 1e-3);
    }
  }
}

TEST(ChebyshevFile, DamagedFilesAreRefusedByName) {
  const std::string good = exported(320).files[0].bytes;
  EXPECT_EQ(messageOf(good), "read");
  EXPECT_TRUE(isChebyshevJson(good));
  EXPECT_FALSE(isChebyshevJson(tableToJson(defaultTable())));
  const auto expect = [&](const std::string& what, const std::string& with, const std::string& message) {
    const std::string got = messageOf(replaced(good, what, with));
    EXPECT_EQ(got.find("F: "), 0u) << got;
    EXPECT_NE(got.find(message), std::string::npos) << got;
  };
  expect("ltc-chebyshev", "ltc-tschebyscheff", "format is not");
  expect("\"version\": 1", "\"version\": 2", "version 2 is not known");
  expect("\"brdf\": \"ggx\"", "\"brdf\": \"beckmann\"", "brdf 'beckmann'");
  expect("\"alpha_floor\": 0.0001", "\"alpha_floor\": 0", "alpha_floor");
  expect("\"alpha_floor\": 0.0001", "\"alpha_floor\": null", "alpha_floor is not a number");
  expect("\"turn\"", "\"torn\"", "functions.turn is missing");
  expect("\"width\": [", "\"width\": [1, ", "functions.width[0] is not an array");
  expect("\"width\": [\n      [", "\"width\": [\n      [\"\", ", "functions.width[0][0] is not a number");
  expect("\"width\": [\n      [", "\"width\": [\n      [0.1, ", "functions.width[0][0] = 0.1 is not a half");
  expect("\"width\": [\n      [", "\"width\": [\n      [1e300, ", "is not a half");
  expect("\"width\": [\n      [", "\"width\": [\n      [-65504, ", "inside out");
  expect("\"width\": [", "\"width\": [[],[],[],[],", "rows, not 8 at most");
  expect("\"width\": [\n      [", "\"width\": [\n      [0,0,0,0,0,0, ", "coefficients, not 8 at most");
  EXPECT_NE(messageOf(good.substr(0, good.size() / 2)).find("not valid JSON"), std::string::npos);
}

TEST(ChebyshevFile, TooFewCoefficientsAreRefused) {
  EXPECT_THROW(exported(94), std::invalid_argument);
  FormatOptions half;
  half.precision = Precision::kHalf;
  EXPECT_THROW(exportTable(defaultTable(), *findFormat("chebyshev"), half, "t"), std::invalid_argument);
  const Table aniso = readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_aniso.json");
  EXPECT_THROW(exportTable(aniso, *findFormat("chebyshev"), {}, "t"), std::invalid_argument);
}

}  // namespace
}  // namespace ltcfit
