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
