#include "tailor/tailored_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tailor/verification.h"
#include "tests/tailor/support.h"

namespace ltcfit {
namespace {

constexpr double kFloor = 1e-4;

TailorOptions quickTailor(bool isotropic, double maxError) {
  TailorOptions o;
  o.maxError = maxError;
  o.model = test::quickModel(isotropic);
  o.checkPoints = isotropic ? 192 : 96;
  return o;
}

TailoredTable tailored(const LobeDistribution& d, const TailorOptions& o) {
  const InterpolationModel model(d, axisRanges(d, kFloor, 0.01), o.model);
  return tailorTable(d, TableDesigns(model), o);
}

TEST(TailoredTable, OneRoughnessIsOneRow) {
  const LobeDistribution d = test::isotropicLobes(0.5, 0.5, 1);
  const TailoredTable made = tailored(d, quickTailor(true, 0.002));
  ASSERT_TRUE(made.kept);
  const auto& axes = made.table->info().axes;
  EXPECT_EQ(axes[1].size(), 1u);
  EXPECT_GT(axes[0].size(), 3u);
  EXPECT_LT(axes[0].size(), 20u);
  // F0 = F90: no Fresnel, so 5 halves a node
  EXPECT_EQ(made.step.bytes, axes[0].size() * 10u);
}

TEST(TailoredTable, KeepsItsBoundAtOtherLookUpsAndCannotLoseANode) {
  const LobeDistribution d = test::isotropicLobes(0.3, 0.7);
  const TailorOptions options = quickTailor(true, 0.002);
  const TailoredTable made = tailored(d, options);
  ASSERT_TRUE(made.kept);
  EXPECT_TRUE(made.step.error.isWithin(0.002));
  EXPECT_EQ(made.precision, Precision::kHalf);
  const FetchCheck unseen(d, 256, options.model, 4321);
  EXPECT_LE(unseen.measure(shippedTable(*made.table, made.precision)).mean, 0.002);
  EXPECT_LE(made.step.bytes, 64u * 64u * 12u / 8u);
  // whatever was tried with fewer bytes was found wanting
  for (const TailorStep& step : made.steps) {
    if (step.bytes < made.step.bytes) {
      EXPECT_FALSE(step.error.isWithin(0.002));
    }
  }
}

TEST(TailoredTable, TheCheckSeesAWorseTable) {
  const LobeDistribution d = test::isotropicLobes(0.3, 0.7);
  const TailorOptions options = quickTailor(true, 0.002);
  const TailoredTable made = tailored(d, options);
  ASSERT_TRUE(made.kept);
  // nodes where the file does not say: the same numbers under another warp
  TableInfo info = made.table->info();
  Axis& theta = info.axes[0];
  theta = makeAxis("theta", "rad", theta.map, theta.size(), theta.low, theta.high, 0.0,
                   {theta.warp[0] + 0.25, theta.warp[1]});
  const Table wrong(info, made.table->data());
  const FetchCheck check(d, 96, options.model, 4321);
  EXPECT_GT(check.measure(shippedTable(wrong, Precision::kHalf)).mean, 0.004);
}

TEST(TailoredTable, BoundsOfBytes) {
  const LobeDistribution d = test::isotropicLobes(0.3, 0.7);
  TailorOptions options = quickTailor(true, 0.0);
  options.maxBytes = 500;
  const TailoredTable best = tailored(d, options);
  ASSERT_TRUE(best.kept);
  EXPECT_LE(best.step.bytes, 500u);
  EXPECT_GT(best.step.bytes, 400u);
  options.maxError = 1e-4;
  const TailoredTable none = tailored(d, options);
  EXPECT_FALSE(none.kept);
  EXPECT_TRUE(none.table.has_value());  // the best there was, to be told of
}

TEST(TailoredTable, FineBoundsTakeFloats) {
  const LobeDistribution d = test::isotropicLobes(0.5, 0.5, 1);
  const TailoredTable made = tailored(d, quickTailor(true, 5e-5));
  EXPECT_EQ(made.precision, Precision::kFloat);
}

TEST(TailoredTable, AnisotropicAndVerified) {
  const LobeDistribution d = test::anisotropicLobes();
  const TailorOptions options = quickTailor(false, 0.012);
  const TailoredTable made = tailored(d, options);
  ASSERT_TRUE(made.kept);
  EXPECT_LT(made.step.bytes, 8u * 8 * 8 * 8 * 24 / 8);
  const Table shipped = shippedTable(*made.table, made.precision);
  VerificationOptions verify;
  verify.lookUps = 96;
  verify.truthPoints = 12;
  verify.scenes = 2;
  verify.pixels = 16;
  verify.seed = 77;
  const Verification v = verifyTable(shipped, shipped, d, 0.012, options.model, verify);
  EXPECT_TRUE(v.holds(0.012));
  EXPECT_FALSE(v.holds(0.5 * v.tailored.mean));
  EXPECT_EQ(v.tailored.mean, v.full.mean);  // the same table
  EXPECT_EQ(v.tailoredLight, v.fullLight);
  EXPECT_EQ(v.tailoredRmse, v.fullRmse);
  EXPECT_EQ(v.scenes, 2u);
  EXPECT_GT(v.directLight[1], 0.0);
  EXPECT_LT(v.directLight[1], 0.05);
  EXPECT_GT(v.tailoredRmse, 0.0);
  EXPECT_LT(v.tailoredRmse, 0.05);
}

TEST(TailoredTable, ThreadsDoNotChangeIt) {
  const LobeDistribution d = test::isotropicLobes(0.5, 0.6, 3);
  TailorOptions options = quickTailor(true, 0.004);
  options.model.threads = 1;
  const TailoredTable one = tailored(d, options);
  options.model.threads = 2;
  const TailoredTable two = tailored(d, options);
  EXPECT_EQ(one.table->data(), two.table->data());
  EXPECT_EQ(one.steps.size(), two.steps.size());
  EXPECT_EQ(one.step.error.mean, two.step.error.mean);
}

}  // namespace
}  // namespace ltcfit
