// Right tables pass; every wrong reading of their numbers is found, and named.
#include "export/reading_verdict.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <filesystem>
#include <functional>

#include "base/angles.h"
#include "export/layouts.h"
#include "export/published_table.h"
#include "export/read_table.h"
#include "ltc/resample.h"
#include "tests/support/tailored.h"

namespace ltcfit {
namespace {

using Node = std::vector<std::size_t>;

const Table& data(const std::string& name) {
  static std::map<std::string, Table> tables;
  const auto found = tables.find(name);
  if (found != tables.end()) return found->second;
  return tables.emplace(name, readTable(std::string(LTCFIT_DATA_DIR) + "/" + name)).first->second;
}

std::vector<Axis> isotropicAxes(AxisMap theta, std::size_t rows, std::size_t columns, double floor = 1e-4) {
  return {makeAxis("theta", "rad", theta, rows, 0.0, kHalfPi),
          makeAxis("alpha", "1", AxisMap::kSqrt, columns, 0.0, 1.0, floor)};
}

void expectPasses(const Table& table, const std::string& name) {
  const ReadingVerdict verdict = judgeReading(table);
  EXPECT_TRUE(verdict.passes()) << name << ": misfit " << verdict.misfit << "\n"
                                << fmt::format("{}", fmt::join(verdict.complaints(), "\n"));
}

// The table with the numbers of other nodes, and other matrices.
Table planted(const Table& table, const std::function<Node(Node)>& nodeOf,
              const std::function<Eigen::Matrix3d(const Eigen::Matrix3d&)>& matrixOf) {
  TableInfo info = table.info();
  info.normalization = MatrixNormalization::kNone;
  info.channels = {"m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22"};
  std::vector<float> numbers;
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    const TableEntry entry = table.entry(nodeOf(table.node(i)));
    const Eigen::Matrix3d m = matrixOf(info.stores == MatrixStorage::kM ? entry.m : entry.mInv);
    for (int c = 0; c < 9; ++c) numbers.push_back(static_cast<float>(m(c / 3, c % 3)));
  }
  return {std::move(info), std::move(numbers)};
}

Node sameNode(Node node) {
  return node;
}
Eigen::Matrix3d sameMatrix(const Eigen::Matrix3d& m) {
  return m;
}
std::function<Node(Node)> reversed(const Table& table, std::size_t axis) {
  return [&table, axis](Node node) {
    node[axis] = table.info().axes[axis].size() - 1 - node[axis];
    return node;
  };
}
std::function<Node(Node)> exchanged(std::size_t a, std::size_t b) {
  return [a, b](Node node) {
    std::swap(node[a], node[b]);
    return node;
  };
}
Table withInfo(const Table& table, const std::function<void(TableInfo&)>& change) {
  TableInfo info = table.info();
  change(info);
  return {std::move(info), table.data()};
}

void expectRead(const Table& table, const std::string& name) {
  const ReadingVerdict verdict = judgeReading(table);
  EXPECT_TRUE(verdict.isBetter()) << name << ": " << verdict.misfit << " against " << verdict.best.misfit
                                  << " with " << verdict.best.name;
  EXPECT_EQ(verdict.best.name, name);
  EXPECT_FALSE(verdict.passes());
  EXPECT_EQ(verdict.complaints().at(0),
            fmt::format("read with {} it fits {:.1f} times better ({:.3f} against {:.3f})", name,
                        verdict.misfit / verdict.best.misfit, verdict.best.misfit, verdict.misfit));
}

TEST(ReadingVerdict, OurTablesPass) {
  for (const char* const name :
       {"ltc_iso.json", "ltc_iso.h", "ltc_iso.ktx2", "ltc_iso.cheb.json", "ltc_aniso.json", "ltc_aniso.h",
        "ltc_aniso.ktx2", "ltc_aniso_refined.json", "ltc_aniso_refined.h", "ltc_aniso_refined.ktx2"})
    expectPasses(data(name), name);
}

TEST(ReadingVerdict, TailoredTablesPass) {
  for (const test::Tailored& t : test::tailoredTables()) expectPasses(t.table, t.name);
}

TEST(ReadingVerdict, TablesOfOtherNodesAndFormsPass) {
  const Table& iso = data("ltc_iso.json");
  for (const AxisMap theta : {AxisMap::kSqrtOneMinusCos, AxisMap::kLinear})
    for (const std::size_t n : {2u, 3u, 4u, 5u, 8u, 32u})
      expectPasses(resampled(iso, isotropicAxes(theta, n, n + 1)), fmt::format("{} rows", n));
  for (const MatrixStorage stores : {MatrixStorage::kM, MatrixStorage::kMinv})
    for (const MatrixNormalization n : {MatrixNormalization::kNone, MatrixNormalization::kThirdColumnUnit,
                                        MatrixNormalization::kMiddleElement})
      expectPasses(storedAs(iso, stores, n), "stored otherwise");
  for (const TableLayout& layout : tableLayouts())
    expectPasses(
        unpack(pack(resampled(iso, isotropicAxes(layout.theta, 16, 16)), layout.packing, Precision::kHalf)),
        std::string(layout.name));
}

TEST(ReadingVerdict, PublishedTablesPass) {
  const std::filesystem::path folder(LTCFIT_REFERENCE_DIR);
  if (!std::filesystem::exists(folder / "ltc2017-1.npy"))
    GTEST_SKIP() << "the published tables are not at " << folder << " (LTCFIT_REFERENCE_DIR)";
  for (const char* const name : {"ltc2017-1.npy", "ltc2017-1.dds", "kt2022-alpha-lambda-theta-phi.npy"})
    expectPasses(readTable(folder / name), name);
  // the table that is furthest from its lobes tells its own axes from those of 2016
  expectRead(withInfo(readTable(folder / "ltc2017-1.npy"),
                      [](TableInfo& info) { info.axes = isotropicAxes(AxisMap::kLinear, 64, 64); }),
             "theta by sqrt(1 - cos theta)");
}

TEST(ReadingVerdict, OtherClosuresAreNotJudged) {
  Table wrong = planted(data("ltc_iso.json"), exchanged(0, 1), sameMatrix);
  EXPECT_FALSE(judgeReading(wrong).passes());
  wrong = withInfo(wrong, [](TableInfo& info) { info.brdf = "sheen"; });
  EXPECT_TRUE(judgeReading(wrong).passes());
}

class IsotropicReading : public testing::TestWithParam<std::size_t> {
 protected:
  Table table() const {
    return resampled(data("ltc_iso.json"), isotropicAxes(AxisMap::kSqrtOneMinusCos, GetParam(), GetParam()));
  }
};
INSTANTIATE_TEST_SUITE_P(Sizes, IsotropicReading, testing::Values(6, 8, 33, 64));

TEST_P(IsotropicReading, WrongAxesAreNamed) {
  const Table t = table();
  expectRead(planted(t, exchanged(0, 1), sameMatrix), "axes exchanged");
  expectRead(planted(t, reversed(t, 0), sameMatrix), "theta reversed");
  expectRead(planted(t, reversed(t, 1), sameMatrix), "alpha reversed");
  expectRead(planted(
                 t, [&](Node node) { return reversed(t, 0)(reversed(t, 1)(std::move(node))); }, sameMatrix),
             "theta reversed, alpha reversed");
  expectRead(planted(
                 t, [&](Node node) { return reversed(t, 0)(exchanged(0, 1)(std::move(node))); }, sameMatrix),
             "axes exchanged, theta reversed");
}

TEST_P(IsotropicReading, WrongMapsAreNamed) {
  const std::size_t n = GetParam();
  const Table t = table();
  const Table linear = resampled(data("ltc_iso.json"), isotropicAxes(AxisMap::kLinear, n, n));
  expectRead(withInfo(linear, [&](TableInfo& info) { info.axes = t.info().axes; }), "theta linear");
  expectRead(withInfo(t, [&](TableInfo& info) { info.axes = linear.info().axes; }),
             "theta by sqrt(1 - cos theta)");
  std::vector<Axis> axes = t.info().axes;
  axes[1] = makeAxis("alpha", "1", AxisMap::kLinear, n, 0.0, 1.0, 1e-4);
  const Table other = resampled(data("ltc_iso.json"), axes);
  expectRead(withInfo(other, [&](TableInfo& info) { info.axes = t.info().axes; }), "alpha linear");
  expectRead(withInfo(t, [&](TableInfo& info) { info.axes = axes; }), "alpha by its square root");
}

TEST_P(IsotropicReading, WrongMatricesAreNamed) {
  const Table t = table();
  const Table inverse = storedAs(t, MatrixStorage::kMinv, MatrixNormalization::kMiddleElement);
  expectRead(withInfo(inverse, [](TableInfo& info) { info.stores = MatrixStorage::kM; }),
             "the inverse of M in it, not M");
  expectRead(planted(t, sameNode, [](const Eigen::Matrix3d& m) { return Eigen::Matrix3d(m.transpose()); }),
             "rows and columns of the matrix exchanged");
  const Eigen::Matrix3d mirror = Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal();
  expectRead(
      planted(t, sameNode, [&](const Eigen::Matrix3d& m) { return Eigen::Matrix3d(mirror * m * mirror); }),
      "x mirrored");
  const Table direct = storedAs(t, MatrixStorage::kM, MatrixNormalization::kMiddleElement);
  expectRead(withInfo(direct, [](TableInfo& info) { info.stores = MatrixStorage::kMinv; }),
             "M in it, not its inverse");
  expectRead(
      planted(inverse, sameNode, [](const Eigen::Matrix3d& m) { return Eigen::Matrix3d(m.transpose()); }),
      "rows and columns of the matrix exchanged");
}

// Textures of four numbers, taken for another engine's.
TEST_P(IsotropicReading, WrongPackingsAreNamed) {
  for (const TableLayout& is : tableLayouts()) {
    if (!is.hasWholeMatrix()) continue;
    const Image image = pack(resampled(data("ltc_iso.json"), isotropicAxes(is.theta, GetParam(), GetParam())),
                             is.packing, Precision::kFloat)
                            .images[0];
    for (const TableLayout& taken : tableLayouts()) {
      if (!taken.hasWholeMatrix() || taken.name == is.name) continue;
      const std::string map = is.theta == taken.theta        ? ""
                              : is.theta == AxisMap::kLinear ? "theta linear, "
                                                             : "theta by sqrt(1 - cos theta), ";
      expectRead(unpack(packedAs(taken, image, nullptr, "T")),
                 fmt::format("{}components in the order of {}", map, is.name));
    }
  }
}

TEST(AnisotropicReading, WrongReadingsAreNamed) {
  const Table& t = data("ltc_aniso.json");
  expectRead(planted(t, exchanged(0, 1), sameMatrix), "axes in the order lambda, alpha, theta, phi");
  expectRead(planted(t, exchanged(2, 3), sameMatrix), "axes in the order alpha, lambda, phi, theta");
  expectRead(planted(
                 t, [](const Node& node) { return Node(node.rbegin(), node.rend()); }, sameMatrix),
             "axes in the order phi, theta, lambda, alpha");
  for (std::size_t a = 0; a < 4; ++a)
    expectRead(planted(t, reversed(t, a), sameMatrix), t.info().axes[a].name + " reversed");
  const Table inverse = storedAs(t, MatrixStorage::kMinv, MatrixNormalization::kMiddleElement);
  expectRead(withInfo(inverse, [](TableInfo& info) { info.stores = MatrixStorage::kM; }),
             "the inverse of M in it, not M");
  expectRead(planted(t, sameNode, [](const Eigen::Matrix3d& m) { return Eigen::Matrix3d(m.transpose()); }),
             "rows and columns of the matrix exchanged");
  const Eigen::Matrix3d turn = Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  expectRead(planted(t, sameNode, [&](const Eigen::Matrix3d& m) { return Eigen::Matrix3d(turn * m * turn); }),
             "x and y mirrored");
}

TEST(AnisotropicReading, AxesAlphaXAndAlphaYAreNamed) {
  const Table& t = data("ltc_aniso.json");
  std::vector<float> numbers;
  for (std::size_t i = 0; i < t.nodeCount(); ++i) {
    const Node node = t.node(i);
    LobeParameters p = t.parameters(node);
    p.alphaY = std::max(t.info().axes[1].values[node[1]], 1e-4);
    const Eigen::Matrix3d m = t.fetch(p).m;
    for (int c = 0; c < 9; ++c) numbers.push_back(static_cast<float>(m(c / 3, c % 3)));
  }
  TableInfo info = t.info();
  info.normalization = MatrixNormalization::kNone;
  info.channels = {"m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22"};
  expectRead(Table(info, numbers), "axes alpha_x, alpha_y instead of alpha, lambda");
}

// Limits name the texel and the component.
TEST(ReadingLimits, NormAndFresnel) {
  const Table& t = data("ltc_iso.json");
  const std::size_t channels = t.channelCount();
  const auto changed = [&](const std::function<void(float&, float&)>& change) {
    std::vector<float> numbers = t.data();
    for (std::size_t i = 0; i < t.nodeCount(); ++i)
      change(numbers[i * channels + channels - 2], numbers[i * channels + channels - 1]);
    return judgeReading(Table(t.info(), numbers));
  };
  ASSERT_EQ(t.info().channels.at(channels - 2), "norm");
  ASSERT_EQ(t.info().channels.at(channels - 1), "fresnel");
  const auto expectBroken = [](const ReadingVerdict& verdict, const std::vector<std::string>& starts) {
    EXPECT_FALSE(verdict.isBetter());
    ASSERT_EQ(verdict.broken.size(), starts.size()) << fmt::format("{}", fmt::join(verdict.broken, "\n"));
    for (std::size_t i = 0; i < starts.size(); ++i)
      EXPECT_TRUE(verdict.broken[i].starts_with(starts[i])) << verdict.broken[i];
  };
  expectBroken(changed([](float&, float&) {}), {});
  expectBroken(changed([](float& norm, float& fresnel) { std::swap(norm, fresnel); }),
               {"Fresnel terms are in 0..norm: not at 6", "Fresnel terms are near GGX's: not at ",
                "norms are near GGX's: not at ", "norms go to 1 at 90 degrees: not at "});
  expectBroken(changed([](float& norm, float&) { norm *= 1.05f; }), {"norms are in (0, 1]: not at "});
  expectBroken(
      changed([](float& norm, float&) { norm = std::min(norm, 0.5f); }),
      {"norms are near GGX's: not at ",
       "norms go to 1 at 90 degrees: not at 8 of 8 nodes, worst at texel y 63, x 0 (theta 90.0 degrees, "
       "alpha 0.0001), norm: 0.500, GGX's "});
  expectBroken(
      changed([](float&, float& fresnel) { fresnel = -0.3f; }),
      {"Fresnel terms are in 0..norm: not at 64 of 64 nodes", "Fresnel terms are near GGX's: not at "});
}

}  // namespace
}  // namespace ltcfit
