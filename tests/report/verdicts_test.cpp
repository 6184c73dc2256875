#include "report/verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>

#include "export/read_table.h"
#include "fit/target_lobe.h"
#include "ggx/moments.h"
#include "ltc/resample.h"
#include "report/points.h"
#include "report/storage_shift.h"

namespace ltcfit {
namespace {

constexpr std::size_t kChannels = 7;
constexpr std::size_t kNorm = 5;
constexpr std::size_t kFresnel = 6;
constexpr char kSingular[] = "Nodes without an inverse in float32";
constexpr char kFetched[] = "Fetched matrices without an inverse in float32, off-grid and extreme";
constexpr char kNormError[] = "Norm, largest error at nodes";
constexpr char kFresnelError[] = "Fresnel, largest error at nodes";
constexpr char kDeterminant[] = "Determinant of the shader's inverse, largest relative error at all points";
constexpr char kMisread[] = "Misfit as read, over the best other reading's";
constexpr char kBroken[] = "Limits of every GGX table that are broken";
constexpr char kHalf[] = "Half precision: largest shift of a lobe, rad";

using Planar = std::array<float, 5>;  // m00, m02, m11, m20, m22

// 3 x 3 nodes of the cosine with the norm and Fresnel of the lobes: no fit, but within every limit. M is as
// it is stored, so that what float32 does to an entry can be worked out.
Table goodTable() {
  TableInfo info;
  info.axes = {makeAxis("theta", "rad", AxisMap::kSqrtOneMinusCos, 3, 0.0, 0.5 * std::numbers::pi),
               makeAxis("alpha", "1", AxisMap::kSqrt, 3, 0.0, 1.0, 0.01)};
  info.stores = MatrixStorage::kM;
  info.normalization = MatrixNormalization::kNone;
  info.channels = {"m00", "m02", "m11", "m20", "m22", "norm", "fresnel"};
  info.alphaFloor = 0.01;
  std::vector<float> data;
  for (std::size_t node = 0; node < 9; ++node) {
    const double alpha = info.axes[1].values[node % 3];
    const LobeMoments moments =
        computeMoments(*makeTargetLobe("ggx", {alpha, alpha, info.axes[0].values[node / 3], 0.0}));
    data.insert(data.end(), {1.0f, 0.0f, 1.0f, 0.0f, 1.0f, static_cast<float>(moments.albedo),
                             static_cast<float>(moments.fresnel)});
  }
  return Table(info, data);
}

Table withMatrix(const Table& table, const std::vector<std::size_t>& nodes, const Planar& matrix) {
  std::vector<float> data = table.data();
  for (const std::size_t node : nodes)
    std::copy(matrix.begin(), matrix.end(), data.begin() + static_cast<std::ptrdiff_t>(node * kChannels));
  return Table(table.info(), data);
}

Table withAdded(const Table& table, std::size_t node, std::size_t channel, float value) {
  std::vector<float> data = table.data();
  data[node * kChannels + channel] += value;
  return Table(table.info(), data);
}

// Products of its entries end in 2^-24, which float32 drops: of the block (a, b; c, a) with a = 1 + 2^-12,
// b = 1, c = 1 + 2^-11 - d the determinant is d + 2^-24, in float32 d.
Planar cancelling(float d) {
  const float a = 1.0f + std::ldexp(1.0f, -12);
  return {a, 1.0f, 1.0f, 1.0f + std::ldexp(1.0f, -11) - d, a};
}

// With LTCFIT_NATIVE compilers fuse products with sums, and nothing is dropped.
bool dropsTheLastBit() {
  const volatile float a = 1.0f + std::ldexp(1.0f, -12);
  const float x = a;
  return x * x - (1.0f + std::ldexp(1.0f, -11)) == 0.0f;
}

ScoreOptions quick(PointSet set) {
  ScoreOptions o;
  o.set = set;
  o.count = set == PointSet::kNodes ? 0 : 40;
  o.metrics.samples = 64;
  o.metrics.directions = o.metrics.quads = o.metrics.lights = 2;
  return o;
}

std::map<std::string, Verdict> allVerdictsOf(const Table& table) {
  std::vector<ScoredSet> sets;
  for (const PointSet set : {PointSet::kNodes, PointSet::kOffGrid, PointSet::kExtreme})
    sets.push_back({set, scoreTables({&table}, quick(set))});
  std::map<std::string, Verdict> out;
  for (const Verdict& v : tableVerdicts({{"t", table, table}}, sets)) out.emplace(v.what, v);
  return out;
}

// Those that say how good a table is: the cosines of goodTable are no GGX lobes, and must be told so.
std::map<std::string, Verdict> verdictsOf(const Table& table) {
  std::map<std::string, Verdict> out = allVerdictsOf(table);
  EXPECT_EQ(out.erase(kMisread), 1u);
  EXPECT_FALSE(out.at(kBroken).passes());
  out.erase(kBroken);
  return out;
}

std::set<std::string> failing(const std::map<std::string, Verdict>& verdicts) {
  std::set<std::string> out;
  for (const auto& [what, verdict] : verdicts)
    if (!verdict.passes()) out.insert(what);
  return out;
}

TEST(Verdicts, ATableThatIsReadWrongFails) {
  const Table whole = readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_iso.json");
  std::vector<Axis> axes = whole.info().axes;
  for (Axis& axis : axes) {  // every ninth node
    std::vector<double> values;
    for (std::size_t i = 0; i < axis.size(); i += 9) values.push_back(axis.values[i]);
    axis.values = std::move(values);
  }
  const Table table = resampled(whole, axes);
  auto verdicts = allVerdictsOf(table);
  EXPECT_TRUE(verdicts.at(kMisread).passes() && verdicts.at(kBroken).passes());
  const std::size_t n = table.info().axes[0].size();
  std::vector<float> exchanged(table.data().size());
  for (std::size_t i = 0; i < table.nodeCount(); ++i)
    std::copy_n(table.data().begin() + static_cast<std::ptrdiff_t>(i * table.channelCount()),
                table.channelCount(),
                exchanged.begin() + static_cast<std::ptrdiff_t>((i % n * n + i / n) * table.channelCount()));
  verdicts = allVerdictsOf(Table(table.info(), exchanged));
  EXPECT_FALSE(verdicts.at(kMisread).passes());
  EXPECT_TRUE(verdicts.at(kMisread).detail.starts_with("read with axes exchanged"))
      << verdicts.at(kMisread).detail;
  EXPECT_FALSE(verdicts.at(kBroken).passes());
}

TEST(Verdicts, AGoodTablePassesAll) {
  const auto verdicts = verdictsOf(goodTable());
  EXPECT_EQ(verdicts.size(), 7u);
  EXPECT_TRUE(failing(verdicts).empty());
  EXPECT_LT(verdicts.at(kDeterminant).value, 1e-14);  // weights of a look-up sum to 1 in double
  EXPECT_EQ(verdicts.at(kHalf).value, 0.0);
  EXPECT_EQ(verdicts.at(kSingular).detail, "of 9 nodes");
  EXPECT_EQ(verdicts.at(kFetched).detail, "of 80 points");
}

TEST(Verdicts, NormAndFresnelAreTheirLargestErrors) {
  // what the moments of the nodes are computed to, and float32 on top
  constexpr double kMomentError = 1e-5;
  const auto fresnel = verdictsOf(withAdded(goodTable(), 4, kFresnel, 0.01f));
  EXPECT_EQ(failing(fresnel), std::set<std::string>{kFresnelError});
  EXPECT_NEAR(fresnel.at(kFresnelError).value, 0.01, kMomentError);
  const auto norm = verdictsOf(withAdded(goodTable(), 7, kNorm, -0.02f));
  EXPECT_EQ(failing(norm), std::set<std::string>{kNormError});
  EXPECT_NEAR(norm.at(kNormError).value, 0.02, kMomentError);
  // two nodes: the larger one
  EXPECT_NEAR(verdictsOf(withAdded(withAdded(goodTable(), 1, kFresnel, 0.03f), 4, kFresnel, -0.002f))
                  .at(kFresnelError)
                  .value,
              0.03, kMomentError);
  // within the limit
  EXPECT_TRUE(failing(verdictsOf(withAdded(goodTable(), 4, kFresnel, 0.0009f))).empty());
}

TEST(Verdicts, NodesThatFloat32CannotInvertAreCounted) {
  if (!dropsTheLastBit()) GTEST_SKIP() << "products are fused with sums";
  // in double there is an inverse, with entries of 2^24, beyond halves; what a shader ends up with has no
  // determinant
  const Planar singular = cancelling(0.0f);
  const auto one = verdictsOf(withMatrix(goodTable(), {4}, singular));
  EXPECT_EQ(one.at(kSingular).value, 1.0);
  EXPECT_EQ(one.at(kFetched).value, 0.0);  // no point is that near to a node
  EXPECT_EQ(failing(one), (std::set<std::string>{kSingular, kDeterminant, kHalf}));
  EXPECT_TRUE(std::isnan(one.at(kDeterminant).value));
  EXPECT_EQ(verdictsOf(withMatrix(goodTable(), {0, 4, 8}, singular)).at(kSingular).value, 3.0);
}

TEST(Verdicts, FetchedMatricesThatFloat32CannotInvertAreCounted) {
  if (!dropsTheLastBit()) GTEST_SKIP() << "products are fused with sums";
  // all four corners of the cell of small theta and alpha: what is fetched there is the same matrix
  const Table table = withMatrix(goodTable(), {0, 1, 3, 4}, cancelling(0.0f));
  const std::vector<Axis>& axes = table.info().axes;
  std::size_t inside = 0;
  for (const PointSet set : {PointSet::kOffGrid, PointSet::kExtreme}) {
    const ScoreOptions o = quick(set);
    for (const Point& p : makePoints(table, set, o.count, o.minAlpha, o.metrics.seed)) {
      inside += axes[0].texelFromValue(p.parameters.theta) < 1.0 &&
                        axes[1].texelFromValue(p.parameters.alphaX) < 1.0
                    ? 1
                    : 0;
    }
  }
  EXPECT_GT(inside, 0u);
  EXPECT_LT(inside, 40u);
  const auto verdicts = verdictsOf(table);
  EXPECT_EQ(verdicts.at(kFetched).value, static_cast<double>(inside));
  EXPECT_EQ(verdicts.at(kSingular).value, 4.0);
  EXPECT_EQ(failing(verdicts), (std::set<std::string>{kSingular, kFetched, kDeterminant, kHalf}));
  // and of all cells all points
  const auto all = verdictsOf(withMatrix(goodTable(), {0, 1, 2, 3, 4, 5, 6, 7, 8}, cancelling(0.0f)));
  EXPECT_EQ(all.at(kFetched).value, 80.0);
  EXPECT_EQ(all.at(kSingular).value, 9.0);
}

TEST(Verdicts, TheDeterminantIsThatOfTheShadersInverse) {
  if (!dropsTheLastBit()) GTEST_SKIP() << "products are fused with sums";
  // The inverse is the cofactors over the determinant, a power of two: of determinant D / d^2 instead of
  // 1 / D.
  const auto errorOf = [](int exponent) {
    return std::pow(1.0 + std::ldexp(1.0, -24 - exponent), 2.0) - 1.0;
  };
  const auto above = verdictsOf(withMatrix(goodTable(), {5}, cancelling(std::ldexp(1.0f, -14))));
  EXPECT_FALSE(above.at(kDeterminant).passes());
  // double cancels 14 of its 52 bits
  EXPECT_NEAR(above.at(kDeterminant).value, errorOf(-14), 1e-10);
  EXPECT_EQ(above.at(kDeterminant).detail,
            "float32 arithmetic against double; above the limit at 1 of 89 points");
  EXPECT_TRUE(above.at(kSingular).passes());
  EXPECT_TRUE(above.at(kFetched).passes());
  const auto below = verdictsOf(withMatrix(goodTable(), {5}, cancelling(std::ldexp(1.0f, -12))));
  EXPECT_NEAR(below.at(kDeterminant).value, errorOf(-12), 1e-10);
  EXPECT_TRUE(below.at(kDeterminant).passes());
}

TEST(Verdicts, HalvesMoveALobeByTheirStep) {
  // A needle 2^-10 wide along (t, 0, 1), t half way between two halves; the other entries of its inverse are
  // halves. It turns by the step 2^-11 of t over 1 + t^2 = 2.
  const float t = 1.0f + std::ldexp(1.0f, -11);
  const float s = std::ldexp(1.0f, -10);
  const auto moved = verdictsOf(withMatrix(goodTable(), {4}, {s, t, s, 0.0f, 1.0f}));
  EXPECT_TRUE(failing(moved).empty());
  // the needle's width and the second order of the step
  EXPECT_NEAR(moved.at(kHalf).value, std::ldexp(1.0, -12), 0.01 * std::ldexp(1.0, -12));
  // 1e5 is beyond the largest half, 65504: to keep the determinant within 1 %, the next entry makes up for it
  const auto lifted = verdictsOf(withMatrix(goodTable(), {4}, {1e-5f, 0.0f, 1.0f, 0.0f, 1.0f}));
  EXPECT_EQ(failing(lifted), std::set<std::string>{kHalf});
  const double factor = 0.9905 * 1e5 / 65504.0;
  const double least = lobeShift(Eigen::Vector3d(1e-5, 1.0, 1.0).asDiagonal(),
                                 Eigen::Vector3d(1.0 / 65504.0, 1.0, 1.0 / factor).asDiagonal());
  EXPECT_GT(lifted.at(kHalf).value, 0.95 * least);  // two sets of directions
  EXPECT_LT(lifted.at(kHalf).value, 2.0 * least);   // and the way to the neighbours
  // the inverse over its middle element is not even in float32: no figure, and no pass
  const auto beyond = verdictsOf(withMatrix(goodTable(), {4}, {1e-20f, 0.0f, 1e20f, 0.0f, 1.0f}));
  EXPECT_EQ(failing(beyond), std::set<std::string>{kHalf});
  EXPECT_TRUE(std::isnan(beyond.at(kHalf).value));
  EXPECT_NE(beyond.at(kHalf).detail.find("the node at alpha 0.25"), std::string::npos)
      << beyond.at(kHalf).detail;
}

}  // namespace
}  // namespace ltcfit
