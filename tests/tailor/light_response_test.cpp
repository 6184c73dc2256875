#include "tailor/light_response.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "ggx/random.h"
#include "ltc/polygon.h"
#include "report/random_lights.h"

namespace ltcfit {
namespace {

// A lobe that leans and has no symmetry.
Eigen::Matrix3d someMatrix() {
  Eigen::Matrix3d m;
  m << 0.3, 0.02, -0.5, 0.01, 0.2, -0.1, 0.15, 0.03, 0.86;
  return m;
}

TEST(LightResponse, StoredFormsAreTheSameLobe) {
  for (const MatrixStorage stores : {MatrixStorage::kM, MatrixStorage::kMinv}) {
    const StoredEntry entry = storedEntry(someMatrix(), 0.9, 0.1, stores);
    const Eigen::Matrix3d back = matrixOf(entry, stores);
    const Eigen::Matrix3d ratio = back * someMatrix().inverse();
    EXPECT_LT((ratio - ratio(0, 0) * Eigen::Matrix3d::Identity()).norm(), 1e-9);
    EXPECT_EQ(entry[9], 0.9);
    EXPECT_EQ(entry[10], 0.1);
  }
  EXPECT_DOUBLE_EQ(storedEntry(someMatrix(), 1, 0, MatrixStorage::kMinv)[4], 1.0);
}

TEST(LightResponse, TheTruthDiffersByNothingAndWhatHasNoInverseByEverything) {
  const StoredEntry truth = storedEntry(someMatrix(), 0.9, 0.1, MatrixStorage::kM);
  const LightResponse response({}, truth, MatrixStorage::kM, 3);
  EXPECT_EQ(response.difference(truth), 0.0);
  StoredEntry singular = truth;
  singular.head(3).setZero();
  EXPECT_TRUE(std::isinf(response.difference(singular)));
}

TEST(LightResponse, TheMetricIsTheSquareOfSmallDifferences) {
  const LookUp lookUp{{}, 0.3, 1.0};
  for (const MatrixStorage stores : {MatrixStorage::kM, MatrixStorage::kMinv}) {
    const StoredEntry truth = storedEntry(someMatrix(), 0.9, 0.1, stores);
    const LightResponse response(lookUp, truth, stores, 5);
    const auto metric = response.metric();
    for (int k = 0; k < 11; ++k) {
      StoredEntry shift = StoredEntry::Zero();
      shift[k] = 1e-4;
      shift[(k + 4) % 11] = -0.5e-4;
      const double linear = std::sqrt(shift.dot(metric * shift));
      // second order: the shift over the lobe's width
      EXPECT_NEAR(response.difference(truth + shift), linear, 5e-3 * linear + 1e-9) << k;
    }
  }
}

TEST(LightResponse, SharpLobesAreJudgedAsByVeryManyLights) {
  // a lobe of width 0.01, moved by a third of that: no light of 96 may notice, and all of 96 x 400 do
  Eigen::Matrix3d m = someMatrix();
  m.col(0) *= 0.03;
  m.col(1) *= 0.05;
  const StoredEntry truth = storedEntry(m, 0.9, 0.0, MatrixStorage::kM);
  Eigen::Matrix3d moved = m;
  moved.col(2) += 0.3 * m.col(0) - 0.2 * m.col(1);
  const StoredEntry entry = storedEntry(moved, 0.9, 0.0, MatrixStorage::kM);
  double exact = 0.0;
  double squares = 0.0;
  constexpr int kSeeds = 400;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const LightResponse response({}, truth, MatrixStorage::kM, static_cast<std::uint64_t>(seed));
    squares += response.difference(entry) * response.difference(entry) / kSeeds;
    Random random(static_cast<std::uint64_t>(seed));
    for (double size : kLightSizes) {
      for (std::size_t i = 0; i < kResponseLights; ++i) {
        const Quad light = randomLight(size, random);
        const double d = 0.9 * (ltcPolygonIntegral(Ltc(moved), light) - ltcPolygonIntegral(Ltc(m), light));
        exact += d * d / (kSeeds * 3.0 * static_cast<double>(kResponseLights));
      }
    }
  }
  // some 150 of the 38,400 lights have an edge in the lobe: a tenth, and the curvature that a widened lobe
  // sees
  EXPECT_NEAR(std::sqrt(squares), std::sqrt(exact), 0.2 * std::sqrt(exact));
}

TEST(LightResponse, WhatReflectsNothingHasAFiniteScale) {
  const StoredEntry truth = storedEntry(someMatrix(), 0.8, 1e-9, MatrixStorage::kM);
  StoredEntry other = truth;
  other[10] += 0.01;
  const double black = LightResponse({{}, 0.0, 1.0}, truth, MatrixStorage::kM, 1).difference(other);
  const double plastic =
      LightResponse({{}, kLeastReflectance, 1.0}, truth, MatrixStorage::kM, 1).difference(other);
  EXPECT_GT(black, 0.0);
  EXPECT_LT(black, 1.1 * plastic);
}

TEST(LightResponse, ADielectricCountsAsMuchAsAMetal) {
  const StoredEntry truth = storedEntry(someMatrix(), 0.8, 0.05, MatrixStorage::kM);
  StoredEntry other = truth;
  other[0] *= 1.1;
  const double metal = LightResponse({{}, 1.0, 1.0}, truth, MatrixStorage::kM, 1).difference(other);
  const double plastic = LightResponse({{}, 0.04, 1.0}, truth, MatrixStorage::kM, 1).difference(other);
  EXPECT_GT(metal, 0.0);
  EXPECT_NEAR(plastic, metal, 1e-12);
  // but Fresnel is the dielectric's alone
  other = truth;
  other[10] *= 1.1;
  EXPECT_EQ(LightResponse({{}, 1.0, 1.0}, truth, MatrixStorage::kM, 1).difference(other), 0.0);
  EXPECT_GT(LightResponse({{}, 0.04, 1.0}, truth, MatrixStorage::kM, 1).difference(other), 1e-3);
}

}  // namespace
}  // namespace ltcfit
