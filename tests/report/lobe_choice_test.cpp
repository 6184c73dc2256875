#include "report/lobe_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace ltcfit {
namespace {

constexpr std::size_t kAlphas = 5;
constexpr std::size_t kChannels = 5;

// 4 thetas by 5 alphas, all the cosine; node = 5 theta + alpha. The first alpha is too sharp for a picture.
Table cosines(const std::vector<std::size_t>& withoutInverse = {}) {
  TableInfo info;
  info.axes = {makeAxis("theta", "rad", AxisMap::kSqrtOneMinusCos, 4, 0.0, 0.5 * std::numbers::pi),
               makeAxis("alpha", "1", AxisMap::kSqrt, kAlphas, 0.0, 1.0, 1e-4)};
  info.channels = {"m00", "m02", "m11", "m20", "m22"};
  info.alphaFloor = 1e-4;
  std::vector<float> data;
  for (std::size_t node = 0; node < 4 * kAlphas; ++node)
    data.insert(data.end(), {1.0f, 0.0f, 1.0f, 0.0f, 1.0f});
  for (const std::size_t node : withoutInverse) data[node * kChannels + 2] = 0.0f;
  return Table(info, data);
}

// The nodes that are ranked, by rising error: each list holds all of them.
const std::vector<std::size_t> kBySw1Rel{17, 13, 6, 9, 18, 11, 19, 14, 7, 2, 3, 1, 12, 16, 4, 8};
const std::vector<std::size_t> kByLight{8, 7, 1, 2, 3, 4, 6, 9, 12, 13, 16, 17, 18, 11, 14, 19};
const std::vector<std::size_t> kByBelow{1, 17, 14, 2, 3, 19, 4, 6, 7, 8, 11, 13, 12, 16, 18, 9};
// Nearest to 80 degrees and alpha 0.05, to 0 and 1, to 60 and 0.25.
constexpr std::size_t kSharpGrazing = 16;
constexpr std::size_t kRoughNormal = 4;
constexpr std::size_t kMedium = 12;

Score planted(const Table& table) {
  Score score;
  score.points = table.nodeCount();
  for (std::size_t i = 0; i < table.nodeCount(); ++i)
    score.all.push_back({table.parameters(table.node(i)), {}});
  const auto plant = [&](Metric metric, const std::vector<std::size_t>& order) {
    for (std::size_t rank = 0; rank < order.size(); ++rank)
      score.all[order[rank]].metrics.set(metric, 0.01 * static_cast<double>(rank + 1));
    // the sharp ones are both better and worse than all others
    for (std::size_t theta = 0; theta < 4; ++theta)
      score.all[kAlphas * theta].metrics.set(metric, theta < 2 ? 0.001 : 9.0);
  };
  plant(Metric::kSw1Rel, kBySw1Rel);
  plant(Metric::kLightM, kByLight);
  plant(Metric::kBelow, kByBelow);
  return score;
}

std::map<std::string, std::size_t> chosen(const Table& table, const Score& score) {
  std::map<std::string, std::size_t> out;
  for (const ChosenLobe& lobe : chooseLobes(table, score))
    EXPECT_TRUE(out.emplace(lobe.why, lobe.node).second) << lobe.why;
  return out;
}

const std::map<std::string, std::size_t> kExpected{
    {"least SW1rel, alpha from 0.01", 17},
    {"largest SW1rel, alpha from 0.01", 8},
    {"median SW1rel, alpha from 0.01", 7},  // the upper one of 16
    {"largest light_m, alpha from 0.01", 19},
    {"most light below the horizon, alpha from 0.01", 9},
    {"sharp, grazing view", kSharpGrazing},
    {"rough, normal view", kRoughNormal},
    {"medium", kMedium}};

TEST(LobeChoice, TakesTheEndsTheMiddleAndThreePlaces) {
  const Table table = cosines();
  EXPECT_EQ(chosen(table, planted(table)), kExpected);
}

TEST(LobeChoice, GoesByTheScoresAndNotByTheOrderOfTheTable) {
  const Table table = cosines();
  Score score = planted(table);
  for (PointScore& p : score.all)
    p.metrics.set(Metric::kSw1Rel, 10.0 - p.metrics.get(Metric::kSw1Rel));  // least is largest
  const auto lobes = chosen(table, score);
  EXPECT_EQ(lobes.at("least SW1rel, alpha from 0.01"), 8u);
  EXPECT_EQ(lobes.at("largest SW1rel, alpha from 0.01"), 17u);
  EXPECT_EQ(lobes.at("median SW1rel, alpha from 0.01"), 14u);
}

TEST(LobeChoice, TakesTheNextWhereOneIsTakenOrHasNoFigureOrNoInverse) {
  const Table table = cosines({17});
  Score score = planted(table);
  score.all[8].metrics.set(Metric::kSw1Rel, std::nan(""));
  score.all[19].metrics.set(Metric::kLightM, std::numeric_limits<double>::infinity());
  score.all[13].metrics.set(Metric::kBelow, 1.0);
  auto expected = kExpected;
  expected["least SW1rel, alpha from 0.01"] = 13;  // 17 has no inverse
  expected["largest SW1rel, alpha from 0.01"] = kRoughNormal;
  expected.erase("rough, normal view");                           // the same
  expected["median SW1rel, alpha from 0.01"] = 14;                // the middle one of 15
  expected["largest light_m, alpha from 0.01"] = 11;              // 19 has none, 14 is taken
  expected["most light below the horizon, alpha from 0.01"] = 9;  // 13 is taken
  EXPECT_EQ(chosen(table, score), expected);
}

TEST(LobeChoice, LobesThatANormalViewSharesAreOne) {
  // alpha, lambda, theta, phi: at theta 0 every phi is the same lobe
  TableInfo info;
  const double right = 0.5 * std::numbers::pi;
  info.axes = {makeAxis("alpha", "1", AxisMap::kSqrt, 2, 0.0, 1.0, 0.04),
               makeAxis("lambda", "1", AxisMap::kLinear, 2, 0.0, 1.0, 0.5),
               makeAxis("theta", "rad", AxisMap::kLinear, 2, 0.0, right),
               makeAxis("phi", "rad", AxisMap::kLinear, 2, 0.0, right)};
  info.channels = {"m00", "m11", "m22"};
  info.alphaFloor = 0.02;
  const Table table(info, std::vector<float>(16 * 3, 1.0f));
  Score score;
  for (std::size_t i = 0; i < 16; ++i) {
    score.all.push_back({table.parameters(table.node(i)), {}});
    // the least two, 0 and 1, are of normal view, of the same alphas; so are the largest two, 12 and 13
    const double value = i < 2 ? 0.1 + 0.01 * static_cast<double>(i) : i < 12 || i > 13 ? 1.0 : 2.0;
    score.all[i].metrics.set(Metric::kSw1Rel, value);
    score.all[i].metrics.set(Metric::kLightM, i == 1 ? 5.0 : i == 6 ? 4.0 : 1.0);
    score.all[i].metrics.set(Metric::kBelow, 0.0);
  }
  const auto lobes = chosen(table, score);
  EXPECT_EQ(lobes.at("least SW1rel, alpha from 0.01"), 0u);
  EXPECT_EQ(lobes.at("largest SW1rel, alpha from 0.01"), 13u);  // rough at normal view too
  EXPECT_EQ(lobes.at("largest light_m, alpha from 0.01"), 6u);  // 1 is 0's lobe
  EXPECT_EQ(lobes.count("rough, normal view"), 0u);
}

}  // namespace
}  // namespace ltcfit
