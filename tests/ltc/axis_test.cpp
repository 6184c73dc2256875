#include "ltc/axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace ltcfit {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

TEST(Axis, MapsAreInversePairs) {
  for (AxisMap map : {AxisMap::kNone, AxisMap::kLinear, AxisMap::kSqrt, AxisMap::kSqrtOneMinusCos}) {
    for (double v : {0.0, 1e-9, 1e-4, 0.1, 0.5, 1.0, 1.5, kHalfPi}) {
      if (map == AxisMap::kSqrt && v > 1.0) continue;
      EXPECT_NEAR(unmapCoordinate(map, mapCoordinate(map, v)), v, 1e-15) << axisMapName(map) << " " << v;
    }
    EXPECT_EQ(map, map == AxisMap::kNone ? AxisMap::kNone : axisMapFromName(axisMapName(map)));
  }
  EXPECT_NEAR(mapCoordinate(AxisMap::kSqrtOneMinusCos, 1.0), std::sqrt(1.0 - std::cos(1.0)), 1e-15);
  EXPECT_EQ(unmapCoordinate(AxisMap::kSqrtOneMinusCos, 1.0), kHalfPi);
  EXPECT_THROW(axisMapFromName("cubic"), std::invalid_argument);
}

TEST(Axis, TexelsAndValuesAreInversePairs) {
  const Axis mapped = makeAxis("theta", "rad", AxisMap::kSqrtOneMinusCos, 64, 0.0, kHalfPi);
  const Axis part = makeAxis("alpha", "1", AxisMap::kSqrt, 9, 0.3, 0.7);
  const Axis free{"alpha", "1", {0.1, 0.15, 0.6, 1.0}, AxisMap::kNone, 0.0, 0.0};
  for (const Axis* axis : {&mapped, &part, &free}) {
    for (double t = 0.0; t <= static_cast<double>(axis->size() - 1); t += 0.37) {
      EXPECT_NEAR(axis->texelFromValue(axis->valueFromTexel(t)), t, 1e-12);
    }
    for (std::size_t i = 0; i < axis->size(); ++i) {
      EXPECT_NEAR(axis->texelFromValue(axis->values[i]), static_cast<double>(i), 1e-12);
    }
    EXPECT_EQ(axis->texelFromValue(-5.0), 0.0);
    EXPECT_EQ(axis->texelFromValue(5.0), static_cast<double>(axis->size() - 1));
  }
  EXPECT_EQ(mapped.values.back(), kHalfPi);
  EXPECT_DOUBLE_EQ(part.values.front(), 0.3);
  EXPECT_DOUBLE_EQ(part.values.back(), 0.7);
}

TEST(Axis, WarpsAreInversePairs) {
  // the last two touch the least density allowed: at an end, and inside
  for (const AxisWarp warp : {AxisWarp{}, AxisWarp{0.6, 0.2}, AxisWarp{-0.8, -0.1}, AxisWarp{0.3, -0.6},
                              AxisWarp{0.95, 0.0}, AxisWarp{-1.2, 0.28}, AxisWarp{0.0, 1.9}}) {
    ASSERT_TRUE(isMonotone(warp)) << warp[0] << " " << warp[1];
    EXPECT_EQ(warpCoordinate(warp, 0.0), 0.0);
    EXPECT_EQ(warpCoordinate(warp, 1.0), 1.0);
    double before = 0.0;
    for (int i = 1; i < 1000; ++i) {
      const double s = i / 1000.0;
      const double t = warpCoordinate(warp, s);
      EXPECT_GT(t - before, 0.9e-3 * kLeastWarpDensity);
      before = t;
      EXPECT_NEAR(unwarpCoordinate(warp, t), s, 1e-13);  // rounding over the least density
      EXPECT_NEAR(warpCoordinate(warp, unwarpCoordinate(warp, s)), s, 1e-14);
    }
  }
  // too sparse at an end, inside, folded, not a number
  for (const AxisWarp warp : {AxisWarp{0.96, 0.0}, AxisWarp{0.0, 1.95}, AxisWarp{0.0, -0.96},
                              AxisWarp{1.5, 0.3}, AxisWarp{std::nan(""), 0.0}}) {
    EXPECT_FALSE(isMonotone(warp)) << warp[0] << " " << warp[1];
  }
}

TEST(Axis, WarpedNodesCrowdWhereToldTo) {
  const Axis low = makeAxis("alpha", "1", AxisMap::kSqrt, 5, 0.09, 0.49, 0.0, {0.8, 0.0});
  const auto gap = [&](std::size_t i) { return std::sqrt(low.values[i + 1]) - std::sqrt(low.values[i]); };
  EXPECT_LT(gap(0), 0.6 * gap(3));
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(low.texelFromValue(low.values[i]), double(i), 1e-12);
  EXPECT_DOUBLE_EQ(low.values.front(), 0.09);
  EXPECT_DOUBLE_EQ(low.values.back(), 0.49);
  EXPECT_FALSE(
      makeAxis("alpha", "1", AxisMap::kSqrt, 5, 0.0, 1.0, 0.0, {0.8, 0.0}).spans(AxisMap::kSqrt, 1.0));
}

TEST(Axis, OneNodeAnswersEverything) {
  const Axis axis = singleNodeAxis("alpha", "1", 0.25);
  for (double v : {0.0, 0.25, 1.0}) EXPECT_EQ(axis.texelFromValue(v), 0.0);
  EXPECT_EQ(axis.valueFromTexel(0.0), 0.25);
  EXPECT_FALSE(axis.spans(AxisMap::kNone, 0.25));
}

TEST(Axis, TheFloorMovesOnlyTheFirstNode) {
  const Axis axis = makeAxis("alpha", "1", AxisMap::kSqrt, 64, 0.0, 1.0, 1e-4);
  EXPECT_EQ(axis.values[0], 1e-4);
  EXPECT_DOUBLE_EQ(axis.values[1], 1.0 / (63.0 * 63.0));
  EXPECT_DOUBLE_EQ(axis.texelFromValue(1e-4), 0.63);  // the shader's formula, not the node's value
  EXPECT_THROW(makeAxis("alpha", "1", AxisMap::kSqrt, 64, 0.0, 1.0, 0.01), std::invalid_argument);
}

TEST(Axis, SpansTellsLayoutsApart) {
  const Axis alpha = makeAxis("alpha", "1", AxisMap::kSqrt, 64, 0.0, 1.0, 1e-4);
  EXPECT_TRUE(alpha.spans(AxisMap::kSqrt, 1.0));  // the clamped first node does not matter
  EXPECT_FALSE(alpha.spans(AxisMap::kLinear, 1.0));
  EXPECT_FALSE(alpha.spans(AxisMap::kSqrt, 0.9));
  EXPECT_FALSE(makeAxis("alpha", "1", AxisMap::kSqrt, 64, 0.1, 1.0).spans(AxisMap::kSqrt, 1.0));
}

}  // namespace
}  // namespace ltcfit
