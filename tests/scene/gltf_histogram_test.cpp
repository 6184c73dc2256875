#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/lobe_histogram.h"

namespace ltcfit {
namespace {

double sum(const std::vector<LobeUse>& lobes) {
  double total = 0.0;
  for (const LobeUse& lobe : lobes) total += lobe.weight;
  return total;
}

TEST(LobeHistogram, OneLobeIsKept) {
  LobeHistogram histogram;
  histogram.add({0.3, 0.1234567, 0.0437, 0.9, 5.0});
  const std::vector<LobeUse> lobes = histogram.lobes(0.25);
  ASSERT_EQ(lobes.size(), 1u);
  // divided by its own weight
  EXPECT_DOUBLE_EQ(lobes[0].alphaX, 0.3);
  EXPECT_DOUBLE_EQ(lobes[0].alphaY, 0.1234567);
  EXPECT_DOUBLE_EQ(lobes[0].f0, 0.0437);
  EXPECT_DOUBLE_EQ(lobes[0].f90, 0.9);
  EXPECT_EQ(lobes[0].weight, 0.25);
}

TEST(LobeHistogram, AlikeLobesBecomeTheirMean) {
  LobeHistogram histogram;
  histogram.add({0.25, 0.25, 0.04, 1.0, 1.0});
  histogram.add({0.2502, 0.2502, 0.05, 1.0, 3.0});
  histogram.add({0.36, 0.36, 0.04, 1.0, 4.0});
  const std::vector<LobeUse> lobes = histogram.lobes(1.0);
  ASSERT_EQ(lobes.size(), 2u);
  EXPECT_NEAR(lobes[0].alphaX, 0.25015, 1e-12);  // rounding
  EXPECT_NEAR(lobes[0].f0, 0.0475, 1e-12);
  EXPECT_NEAR(lobes[0].weight, 0.5, 1e-12);
  EXPECT_EQ(lobes[0].alphaX, lobes[0].alphaY);
}

TEST(LobeHistogram, IsotropicStaysApart) {
  LobeHistogram histogram;
  for (int i = 0; i < 256; ++i)
    for (int k = 0; k < 256; ++k) {
      const double alpha = std::pow(i / 255.0, 2.0);
      histogram.add({alpha + (1.0 - alpha) * std::pow(k / 255.0, 2.0), alpha, 0.04, 1.0, 1.0});
    }
  const std::vector<LobeUse> lobes = histogram.lobes(1.0);
  EXPECT_LE(lobes.size(), LobeHistogram::kMaxLobes + 4);
  EXPECT_GT(lobes.size(), LobeHistogram::kMaxLobes / 8);  // coarsened no more than needed, by halving twice
  EXPECT_NEAR(sum(lobes), 1.0, 1e-9);                     // 65536 additions
  double isotropic = 0.0;
  for (const LobeUse& lobe : lobes) {
    EXPECT_GE(lobe.alphaX, lobe.alphaY);
    if (lobe.alphaX == lobe.alphaY) isotropic += lobe.weight;
  }
  // strength 0, and any at the roughness 1
  EXPECT_NEAR(isotropic, (255.0 + 256.0) / 65536.0, 5.0 / 65536.0);  // and the four ends besides
}

TEST(LobeHistogram, RangesStayWhereStepsGrow) {
  LobeHistogram histogram;
  for (int i = 20; i < 236; ++i)
    for (int k = 20; k < 236; ++k) {
      const double alpha = std::pow(i / 255.0, 2.0);
      histogram.add({alpha + (1.0 - alpha) * std::pow(k / 255.0, 2.0), alpha, 0.04, 1.0, 1.0});
    }
  const std::vector<LobeUse> lobes = histogram.lobes(0.5);
  const double least = std::pow(20 / 255.0, 2.0);
  const double most = std::pow(235 / 255.0, 2.0);
  double low = 1.0;
  double high = 0.0;
  double flattest = 1.0;
  double weight = 0.0;
  for (const LobeUse& lobe : lobes) {
    low = std::min(low, lobe.alphaX);
    high = std::max(high, lobe.alphaX);
    flattest = std::min(flattest, lobe.alphaY / lobe.alphaX);
    weight += lobe.weight;
  }
  EXPECT_DOUBLE_EQ(low, least + (1.0 - least) * least);
  EXPECT_DOUBLE_EQ(high, most + (1.0 - most) * most);
  EXPECT_DOUBLE_EQ(flattest, least / (least + (1.0 - least) * most));
  EXPECT_NEAR(weight, 0.5, 1e-12);
}

}  // namespace
}  // namespace ltcfit
