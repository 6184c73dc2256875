#include "ltc/chebyshev.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "ltc/chebyshev_fit.h"

namespace ltcfit {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

// A form like that of a real table: lobes of width 2 that narrow with alpha and turn at grazing view.
ChebyshevForm sampleForm() {
  ChebyshevForm form;
  form.alphaFloor = 1e-3;
  form.functions[0] = {{1.9, -0.3, -0.1}, {-0.2, 0.05}, {0.1, 0.03, 0.02}};
  form.functions[1] = {{0.05, -0.1}, {0.1}, {0.03}};
  form.functions[2] = {{0.5, 0.2}, {-0.4, 0.15, 0.01}, {0.1}};
  form.functions[3] = {{-0.2, -0.1, 0.05}, {0.1}};
  form.functions[4] = {{0.2, 0.25}, {-0.05, 0.02}};
  form.functions[5] = {{0.2, -0.01}, {-0.03, 0.02}, {0.01}};
  form.provenance.command = "by hand";
  return form;
}

struct Places {
  std::mt19937 random{7};
  LobeParameters next(double floor) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const double root = std::sqrt(floor) + (1.0 - std::sqrt(floor)) * uniform(random);
    return {root * root, root * root, std::acos(1.0 - std::pow(uniform(random), 2)), 0.0};
  }
};

TEST(Chebyshev, SumsThePolynomialsOfItsRows) {
  ChebyshevForm form;
  form.functions[2] = {{}, {0.0, 0.0, 2.0}, {}, {0.0, -1.0}};
  for (const double x : {-1.0, -0.3, 0.7, 1.0}) {
    for (const double s : {-1.0, -0.55, 0.2, 1.0}) {
      const double expected = 2.0 * s * std::cos(2.0 * std::acos(x)) - std::cos(3.0 * std::acos(s)) * x;
      EXPECT_NEAR(form.function(ChebyshevFunction::kTurn, {x, s}), expected, 1e-14);
    }
  }
  EXPECT_EQ(form.function(ChebyshevFunction::kShear, {0.3, 0.4}), 0.0);
  EXPECT_EQ(form.coefficients(), 5u);
}

TEST(Chebyshev, CoordinatesReachTheEndsOfTheirRange) {
  for (const double alpha : {1e-4, 0.01, 1.0}) {
    EXPECT_EQ(chebyshevPoint(alpha, 0.0).s, -1.0);
    EXPECT_NEAR(chebyshevPoint(alpha, 1.0).s, 1.0, 1e-15);
  }
  EXPECT_EQ(chebyshevPoint(1.0, 0.5).x, 1.0);
  EXPECT_NEAR(chebyshevPoint(0.25, 0.5).x, 0.0, 1e-15);
}

TEST(Chebyshev, NormalViewAndDeterminantHoldByConstruction) {
  const ChebyshevForm form = sampleForm();
  Places places;
  for (int i = 0; i < 300; ++i) {
    LobeParameters p = places.next(form.alphaFloor);
    const TableEntry entry = form.evaluate(p);
    ASSERT_TRUE(entry.invertible);
    EXPECT_GT(entry.m.determinant(), 0.0);
    EXPECT_NEAR(entry.m.col(2).norm(), 1.0, 1e-14);
    EXPECT_EQ(entry.m(0, 1), 0.0);
    EXPECT_EQ(entry.m(1, 2), 0.0);
    p.theta = 0.0;
    const TableEntry above = form.evaluate(p);
    EXPECT_EQ(above.m(0, 0), above.m(1, 1));
    EXPECT_EQ(above.m(0, 2), 0.0);
    EXPECT_EQ(above.m(2, 0), 0.0);
    EXPECT_EQ(above.m(2, 2), 1.0);
  }
  EXPECT_EQ(*form.evaluate({0.2, 0.2, kHalfPi, 0.0}).norm, 1.0);
  // below the floor all are its lobe
  EXPECT_EQ(form.evaluate({0.0, 0.0, 1.0, 0.0}).m, form.evaluate({1e-3, 1e-3, 1.0, 0.0}).m);
}

TEST(Chebyshev, APlantedFormIsFoundAgain) {
  const ChebyshevForm planted = sampleForm();
  ChebyshevOptions options;
  options.coefficients = 60;
  const Table table = tableOfChebyshev(planted, 33);
  const ChebyshevForm fit = fitChebyshev(table, options);
  EXPECT_EQ(fit.alphaFloor, planted.alphaFloor);
  EXPECT_EQ(fit.provenance.command, "by hand");
  Places places;
  for (int i = 0; i < 300; ++i) {
    const LobeParameters p = places.next(planted.alphaFloor);
    const TableEntry expected = planted.evaluate(p);
    const TableEntry found = fit.evaluate(p);
    // float32 of the table, over lobes of width alpha
    EXPECT_LT((found.m - expected.m).cwiseAbs().maxCoeff(), 1e-5 * std::sqrt(p.alphaX));
    EXPECT_NEAR(*found.norm, *expected.norm, 1e-5);
    EXPECT_NEAR(*found.fresnel, *expected.fresnel, 1e-5);
  }
  const ChebyshevDifference difference = chebyshevDifference(fit, table);
  EXPECT_LT(difference.largestShift, 1e-4);
  EXPECT_LT(difference.largestNorm, 1e-5);
  EXPECT_LT(difference.largestFresnel, 1e-5);
}

TEST(Chebyshev, TheInverseOfAMirroredMatrixIsTheSameTable) {
  const Table table = tableOfChebyshev(sampleForm(), 17);
  std::vector<float> data = table.data();
  // m00 and m20, then m11, of every node
  for (std::size_t i = 0; i < data.size(); i += 7) {
    data[i] *= -1.0f;
    data[i + 2] *= -1.0f;
    data[i + 3] *= -1.0f;
  }
  const Table mirrored =
      storedAs(Table(table.info(), data), MatrixStorage::kMinv, MatrixNormalization::kNone);
  ChebyshevOptions options;
  options.coefficients = 60;
  const ChebyshevForm a = fitChebyshev(table, options);
  const ChebyshevForm b = fitChebyshev(mirrored, options);
  Places places;
  for (int i = 0; i < 50; ++i) {
    const LobeParameters p = places.next(1e-3);
    // the inverse in float32
    EXPECT_LT((a.evaluate(p).m - b.evaluate(p).m).cwiseAbs().maxCoeff(), 1e-4 * std::sqrt(p.alphaX));
  }
}

TEST(Chebyshev, RoundingIsTakenUpByWhatIsRoundedLater) {
  // with something for every coefficient to do: one that is 0 rounds without a loss
  ChebyshevForm full = sampleForm();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> small(-0.05, 0.05);
  for (auto& rows : full.functions) {
    rows.resize(6);
    for (std::size_t j = 0; j < rows.size(); ++j) {
      rows[j].resize(6);
      for (std::size_t i = 0; i < 6; ++i) rows[j][i] += small(random) / static_cast<double>(1 + i + j);
    }
  }
  const Table table = tableOfChebyshev(full, 33);
  const auto coarse = [](double c) { return std::round(c * 128.0) / 128.0; };
  ChebyshevOptions options;
  options.coefficients = 216;
  const ChebyshevForm exact = fitChebyshev(table, options);
  options.round = coarse;
  const ChebyshevForm rounded = fitChebyshev(table, options);
  ChebyshevForm nearest = exact;
  for (auto& rows : nearest.functions)
    for (auto& row : rows)
      for (double& c : row) c = coarse(c);
  for (const auto& rows : rounded.functions)
    for (const auto& row : rows)
      for (const double c : row) EXPECT_EQ(c, coarse(c));
  const ChebyshevDifference with = chebyshevDifference(rounded, table);
  const ChebyshevDifference without = chebyshevDifference(nearest, table);
  EXPECT_LT(with.meanShift, 0.8 * without.meanShift);
  EXPECT_LT(with.meanNorm, 0.8 * without.meanNorm);
}

TEST(Chebyshev, ResampledTableHasItsLobes) {
  const ChebyshevForm form = sampleForm();
  const Table table = tableOfChebyshev(form, 65);
  EXPECT_EQ(table.info().alphaFloor, form.alphaFloor);
  for (const std::size_t i : {std::size_t{0}, std::size_t{64}, std::size_t{2000}, table.nodeCount() - 1}) {
    const auto node = table.node(i);
    EXPECT_LT((table.entry(node).m - form.evaluate(table.parameters(node)).m).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST(Chebyshev, RefusesTablesWithoutPlace) {
  const Table good = tableOfChebyshev(sampleForm(), 9);
  ChebyshevOptions options;
  options.coefficients = kLeastCoefficients - 1;
  EXPECT_THROW(fitChebyshev(good, options), std::invalid_argument);
  options.coefficients = kMostCoefficients + 1;
  EXPECT_THROW(fitChebyshev(good, options), std::invalid_argument);
  options.coefficients = 60;
  EXPECT_NO_THROW(fitChebyshev(good, options));
  EXPECT_THROW(fitChebyshev(tableOfChebyshev(sampleForm(), 4), options), std::invalid_argument);

  TableInfo info = good.info();
  info.channels[6] = "m01";
  EXPECT_THROW(fitChebyshev(Table(info, good.data()), options), std::invalid_argument);
  info = good.info();
  info.axes[1] = makeAxis("alpha", "1", AxisMap::kSqrt, 9, 0.1, 1.0);
  EXPECT_THROW(fitChebyshev(Table(info, good.data()), options), std::invalid_argument);
  info.axes[1] = makeAxis("alpha", "1", AxisMap::kSqrt, 9, 0.0, 0.5);
  EXPECT_THROW(fitChebyshev(Table(info, good.data()), options), std::invalid_argument);
  info = good.info();
  info.axes[0] = makeAxis("theta", "rad", AxisMap::kSqrtOneMinusCos, 9, 0.0, 1.2);
  EXPECT_THROW(fitChebyshev(Table(info, good.data()), options), std::invalid_argument);
  info = good.info();
  info.alphaFloor = 0.0;
  EXPECT_THROW(fitChebyshev(Table(info, good.data()), options), std::invalid_argument);
  std::vector<float> data = good.data();
  data[2] = 0.0f;  // m11
  EXPECT_THROW(fitChebyshev(Table(good.info(), data), options), std::invalid_argument);
  data = good.data();
  data[7 * 40 + 4] *= -1.0f;  // m22
  EXPECT_THROW(fitChebyshev(Table(good.info(), data), options), std::invalid_argument);

  info = good.info();
  info.axes = {makeAxis("alpha", "1", AxisMap::kLinear, 2, 0.0, 1.0),
               makeAxis("lambda", "1", AxisMap::kLinear, 2, 0.0, 1.0),
               makeAxis("theta", "rad", AxisMap::kLinear, 2, 0.0, kHalfPi),
               makeAxis("phi", "rad", AxisMap::kLinear, 2, 0.0, kHalfPi)};
  EXPECT_THROW(fitChebyshev(Table(info, {good.data().begin(), good.data().begin() + 7 * 16}), options),
               std::invalid_argument);
}

TEST(Chebyshev, TheCheckFindsWhatNoShaderCouldUse) {
  EXPECT_NO_THROW(checkChebyshev(sampleForm()));
  const auto refused = [](const auto& spoil) {
    ChebyshevForm form = sampleForm();
    spoil(form);
    EXPECT_THROW(checkChebyshev(form), std::invalid_argument);
  };
  refused([](ChebyshevForm& f) { f.alphaFloor = 0.0; });
  refused([](ChebyshevForm& f) { f.alphaFloor = std::nan(""); });
  refused([](ChebyshevForm& f) { f.functions[1].resize(kChebyshevRows + 1); });
  refused([](ChebyshevForm& f) { f.functions[1][0].resize(kChebyshevColumns + 1); });
  refused([](ChebyshevForm& f) { f.functions[5][0][0] = std::numeric_limits<double>::infinity(); });
  refused([](ChebyshevForm& f) { f.functions[4][0][0] = 1e308, f.functions[4][0][1] = 1e308; });
  refused([](ChebyshevForm& f) { f.functions[0] = {{0.0}}; });
  refused([](ChebyshevForm& f) { f.functions[0][0][0] = 0.5; });   // negative for large alpha
  refused([](ChebyshevForm& f) { f.functions[1][0][0] = -1.5; });  // so across
  refused([](ChebyshevForm& f) { f.functions[2] = {{-1.0}}; });    // psi beyond 90 degrees
}

}  // namespace
}  // namespace ltcfit
