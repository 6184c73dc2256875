// The anisotropic table in data/, looked at as a shader and as a critic would.
#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <tuple>

#include "export/read_table.h"
#include "fit/moment_start.h"
#include "fit/projected_cdf_loss.h"
#include "fit/table_fit.h"
#include "fit/table_plan.h"
#include "fit/target_lobe.h"
#include "ggx/ggx_lobe.h"
#include "ggx/random.h"
#include "ltc/ltc.h"
#include "report/score.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;

const Table& ours() {
  static const Table table = readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_aniso.json");
  return table;
}

TEST(AnisotropicTable, HasTheSymmetriesOfTheLobe) {
  const Table& t = ours();
  for (std::size_t i = 0; i < t.nodeCount(); ++i) {
    const auto node = t.node(i);
    const LobeParameters p = t.parameters(node);
    const Matrix3d m = t.entry(node).m;
    EXPECT_EQ(projectOnFamily(m, familyOf(p)), m) << "zeros of eq. 16 at node " << i;
    EXPECT_GT(m.determinant(), 0.0) << i;
    EXPECT_TRUE(isInvertibleInFloat(m)) << i;
    EXPECT_NEAR(m.col(2).norm(), 1.0, 2e-7) << i;
    auto first = node;
    first[3] = 0;
    const Matrix3d m0 = t.entry(first).m;
    if (p.theta == 0.0) {
      EXPECT_EQ(m, m0) << i;
    }
    if (p.alphaX == p.alphaY) {
      EXPECT_LT((m - turned(m0, p.phi)).cwiseAbs().maxCoeff(), 1e-6) << i;
      if (p.theta == 0.0) {
        EXPECT_NEAR(m(0, 0), m(1, 1), 1e-6) << i;
      }
    }
  }
}

// Largest entry of the difference of two look-ups a small step apart, against what the table's slopes allow.
double jump(const LobeParameters& a, const LobeParameters& b) {
  return (ours().fetch(a).m - ours().fetch(b).m).cwiseAbs().maxCoeff();
}

TEST(AnisotropicTable, LookUpIsContinuousAcrossEverySeam) {
  const double h = 1e-9;
  // an entry changes by at most 2 over a cell of width 1/7 in any of the four coordinates; lambda changes by
  // h / alpha
  const auto allowed = [&](double alpha) { return 100.0 * h / alpha; };
  Random random(4);
  for (int i = 0; i < 4000; ++i) {
    const double ax = 0.01 + 0.99 * random.uniform();
    const double ay = 0.01 + 0.99 * random.uniform();
    const double theta = 0.5 * kPi * random.uniform();
    for (const double seam : {0.0, 0.5 * kPi, kPi, 1.5 * kPi, 2.0 * kPi})
      EXPECT_LT(jump({ax, ay, theta, seam - h}, {ax, ay, theta, seam + h}), allowed(std::min(ax, ay)))
          << ax << " " << ay << " " << theta << " phi " << seam;
    const double phi = 2.0 * kPi * random.uniform();
    EXPECT_LT(jump({ax, ax * (1.0 + h), theta, phi}, {ax, ax * (1.0 - h), theta, phi}), allowed(ax))
        << ax << " " << theta << " " << phi << " alpha_x = alpha_y";
    const double other = 2.0 * kPi * random.uniform();
    // all azimuths meet at normal view, those of the other quadrants too
    EXPECT_LT(jump({ax, ay, h, phi}, {ax, ay, h, other}), allowed(std::min(ax, ay)))
        << ax << " " << ay << " theta 0";
  }
}

TEST(AnisotropicTable, IsWhatItStandsForInAllQuadrantsAndBothOrders) {
  Random random(5);
  for (int i = 0; i < 60; ++i) {
    const LobeParameters p{0.1 + 0.9 * random.uniform(), 0.1 + 0.9 * random.uniform(), 1.2 * random.uniform(),
                           2.0 * kPi * random.uniform()};
    const auto lobe = makeTargetLobe("ggx", p);
    const LobeSamples samples = weightedSamples(*lobe, 2048, 3);
    const Ltc ltc(ours().fetch(p).m);
    const R2Sequence points(9);
    Vector3d mean = Vector3d::Zero();
    for (std::uint64_t k = 0; k < 2048; ++k) mean += ltc.sample(points(k)) / 2048.0;
    // interpolation moves means by some hundredths; a wrong quadrant by tenths
    EXPECT_LT((mean - samples.mean()).norm(), 0.08)
        << p.alphaX << " " << p.alphaY << " " << p.theta << " " << p.phi;
  }
}

TEST(AnisotropicTable, ManyLookUpsAreFinite) {
  Random random(6);
  for (int i = 0; i < 100000; ++i) {
    LobeParameters p{random.uniform(), random.uniform(), 0.5 * kPi * random.uniform(),
                     8.0 * random.uniform() - 1.0};
    if (i % 5 == 0) p.theta = 0.5 * kPi;
    if (i % 7 == 0) p.alphaY = p.alphaX;
    if (i % 11 == 0) p.alphaX = 1e-5;
    if (i % 13 == 0) p.theta = 0.0;
    if (i % 17 == 0) p.alphaX = p.alphaY = 0.0;
    const TableEntry e = ours().fetch(p);
    ASSERT_TRUE(e.invertible && e.m.allFinite() && e.mInv.allFinite())
        << p.alphaX << " " << p.alphaY << " " << p.theta;
    // beyond 900:1 column 1 of neighbouring nodes can point apart (DESIGN.md, Known limits)
    const double ratio = std::min(p.alphaX, p.alphaY) / std::max(p.alphaX, p.alphaY);
    if (ratio > 0.002) {
      ASSERT_GT(e.m.determinant(), 0.0) << p.alphaX << " " << p.alphaY;
    }
    ASSERT_TRUE(isInvertibleInFloat(e.m));
    ASSERT_TRUE(*e.norm > 0.0 && *e.norm <= 1.0 + 1e-6 && *e.fresnel >= 0.0 && *e.fresnel <= *e.norm);
  }
}

TEST(AnisotropicTable, NormAndFresnelAgreeWithSamplingAtEveryNode) {
  const Table& t = ours();
  double worst = 0.0;
#pragma omp parallel for schedule(dynamic, 16) reduction(max : worst)
  for (std::size_t i = 0; i < t.nodeCount(); ++i) {
    const auto node = t.node(i);
    const LobeParameters p = t.parameters(node);
    const auto lobe = makeTargetLobe("ggx", p);
    const R2Sequence points(i);
    constexpr int n = 1 << 14;
    double norm = 0.0;
    double fresnel = 0.0;
    for (int k = 0; k < n; ++k) {
      const LobeSample s = lobe->sample(points(static_cast<std::uint64_t>(k)));
      const double c = std::max(0.0, 1.0 - 0.5 * (lobe->wo() + s.wi).norm());
      norm += s.weight / n;
      fresnel += s.weight * std::pow(c, 5) / n;
    }
    const TableEntry e = t.entry(node);
    worst = std::max({worst, std::abs(norm - *e.norm), std::abs(fresnel - *e.fresnel)});
  }
  EXPECT_LT(worst, 1e-3);
}

const char* referencePath() {
  return LTCFIT_REFERENCE_DIR "/kt2022-alpha-lambda-theta-phi.npy";
}

TEST(AnisotropicTable, BeatsThePublishedOneOnLights) {
  if (!std::filesystem::exists(referencePath()))
    GTEST_SKIP() << "the published tables are not at " << referencePath() << " (LTCFIT_REFERENCE_DIR)";
  const Table theirs = readTable(referencePath());
  ScoreOptions options;
  options.metrics.samples = 256;
  options.metrics.directions = 2;
  options.metrics.quads = 16;
  options.metrics.seed = 31;
  options.count = 800;
  // of the published table's mean: limits some hundredths above the figures of DESIGN.md over all nodes and
  // more lights, since the rarest lights carry much of each mean. "below" has its own.
  for (const auto& [set, small, medium, large, below] :
       {std::tuple{PointSet::kOffGrid, 0.97, 0.95, 1.0, 1.15},
        std::tuple{PointSet::kExtreme, 0.97, 0.97, 1.02, 1.0}}) {
    options.set = set;
    const std::vector<Score> scores = scoreTables({&ours(), &theirs}, options);
    const auto ratio = [&](Metric m) {
      const auto k = static_cast<std::size_t>(m);
      return scores[0].summary[k].mean / scores[1].summary[k].mean;
    };
    EXPECT_LT(ratio(Metric::kLightS), small) << pointSetName(set);
    EXPECT_LT(ratio(Metric::kLightM), medium) << pointSetName(set);
    EXPECT_LT(ratio(Metric::kLightL), large) << pointSetName(set);
    EXPECT_LT(ratio(Metric::kBelow), below) << pointSetName(set);
    std::printf("%s: light s/m/l %.3f %.3f %.3f, below %.3f of the published table's\n",
                std::string(pointSetName(set)).c_str(), ratio(Metric::kLightS), ratio(Metric::kLightM),
                ratio(Metric::kLightL), ratio(Metric::kBelow));
  }
}

// SW1 of a matrix on samples that no fit has seen.
double unseenSw1(const Lobe& lobe, const Matrix3d& m, std::size_t i, int samples, int slices) {
  const LobeSamples target = weightedSamples(lobe, samples, 77);
  Random random(1000 + i);
  std::vector<Vector3d> directions;
  for (int k = 0; k < slices; ++k) {
    const double z = 2.0 * (k + random.uniform()) / slices - 1.0;
    const double phi = 2.0 * kPi * random.uniform();
    const double r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
  }
  ProjectedCdfLoss loss(target, momentStart(target), cosineSamples(samples, 78), directions);
  return loss(m, nullptr);
}

TEST(SlicedWassersteinNodes, BeatThePublishedOnes) {
  if (!std::filesystem::exists(referencePath()))
    GTEST_SKIP() << "the published tables are not at " << referencePath() << " (LTCFIT_REFERENCE_DIR)";
  const Table theirs = readTable(referencePath());
  double sum = 0.0;
  double theirSum = 0.0;
  double worst = 0.0;
  TableFitOptions options;
  options.fitter = Fitter::kSlicedWasserstein;
  // every fifth node: all axes are of length 8, so that each value of each comes up
#pragma omp parallel for schedule(dynamic, 4) reduction(+ : sum, theirSum) reduction(max : worst)
  for (std::size_t i = 0; i < theirs.nodeCount(); i += 5) {
    const auto node = theirs.node(i);
    if (node[2] == 7) continue;  // 0.9999 pi/2, where sharp lobes are half cut by the horizon
    const LobeParameters p = theirs.parameters(node);
    const auto lobe = makeTargetLobe("ggx", p);
    const Matrix3d m = fitJob({p, familyOf(p)}, "ggx", options).m;
    double a = unseenSw1(*lobe, m, i, 4096, 32);
    double b = unseenSw1(*lobe, theirs.entry(node).m, i, 4096, 32);
    sum += a;
    theirSum += b;
    if (a > 1.005 * b) {  // close: once more, without the noise
      a = unseenSw1(*lobe, m, i, 65536, 512);
      b = unseenSw1(*lobe, theirs.entry(node).m, i, 65536, 512);
    }
    worst = std::max(worst, a / b);
  }
  EXPECT_LT(sum, 0.995 * theirSum);
  EXPECT_LT(worst, 1.02);
  std::printf("mean SW1 %.4f of the published table's, worst node %.4f\n", sum / theirSum, worst);
}

}  // namespace
}  // namespace ltcfit
