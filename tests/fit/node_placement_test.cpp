#include "fit/node_placement.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

#include "fit/table_plan.h"

namespace ltcfit {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

TEST(NodePlacement, DefaultsAreThePublishedLayouts) {
  EXPECT_EQ(IsotropicTableOptions{}.axes, isotropicPlacement("2017"));
  EXPECT_EQ(AnisotropicTableOptions{}.axes, anisotropicPlacement("2022"));
  EXPECT_THROW(isotropicPlacement("2022"), std::invalid_argument);
  EXPECT_THROW(anisotropicPlacement("2017"), std::invalid_argument);
  const TablePlan plan = planAnisotropicTable(AnisotropicTableOptions{}, SymmetryMode::kDuring);
  for (const Axis& axis : plan.info.axes)
    EXPECT_TRUE(axis.spans(AxisMap::kLinear, axis.unit == "rad" ? kHalfPi : 1.0)) << axis.name;
}

// Exact symmetries of the lobes at the ends need exact ends, whatever the map and warp.
TEST(NodePlacement, AxesReachFromEndToEnd) {
  for (std::string_view name : kAnisotropicAxisNames) {
    const bool angle = name == "theta" || name == "phi";
    for (const AxisMap map : {AxisMap::kLinear, angle ? AxisMap::kSqrtOneMinusCos : AxisMap::kSqrt}) {
      for (const AxisWarp& warp : {AxisWarp{}, AxisWarp{0.6, 0.2}, AxisWarp{-0.3, -0.4}}) {
        const Axis axis = placedAxis(name, {map, warp, {}}, 7);
        EXPECT_EQ(axis.values.front(), 0.0);
        EXPECT_EQ(axis.values.back(), angle ? kHalfPi : 1.0);
        for (std::size_t i = 0; i < 7; ++i)
          EXPECT_NEAR(axis.texelFromValue(axis.values[i]), static_cast<double>(i), 1e-9);
      }
    }
  }
  const Axis knots = placedAxis("alpha", {AxisMap::kNone, {}, {0.0, 0.2, 1.0}}, 3, 1e-4);
  EXPECT_EQ(knots.values, (std::vector<double>{1e-4, 0.2, 1.0}));
  EXPECT_DOUBLE_EQ(knots.texelFromValue(0.6), 1.5);
}

std::string messageOf(const AnisotropicPlacement& axes) {
  AnisotropicTableOptions options;
  options.alphaNodes = options.lambdaNodes = options.thetaNodes = options.phiNodes = 3;
  options.axes = axes;
  std::string error;
  return options.isValid(&error) ? "" : error;
}

TEST(NodePlacement, OptionsAreCheckedByName) {
  const auto contains = [](const std::string& text, const char* what) {
    return text.find(what) != std::string::npos;
  };
  AnisotropicPlacement axes;
  EXPECT_EQ(messageOf(axes), "");
  axes[0] = {AxisMap::kSqrtOneMinusCos};
  EXPECT_TRUE(contains(messageOf(axes), "--axes alpha: sqrt-one-minus-cos is a map of angles"));
  axes[0] = {AxisMap::kLinear, {0.99, 0.0}};
  EXPECT_TRUE(contains(messageOf(axes), "--axes alpha: the warp 0.99:0")) << messageOf(axes);
  EXPECT_TRUE(contains(messageOf(axes), "down to 0.01 of its mean, need 0.05 or more"));
  axes[0] = {};
  axes[3] = {AxisMap::kSqrt};
  EXPECT_TRUE(contains(messageOf(axes), "--axes phi: sqrt is a map of alpha and lambda"));
  axes[3] = {AxisMap::kNone, {}, {0.0, kHalfPi}};
  EXPECT_TRUE(contains(messageOf(axes), "--axes phi: 2 knots for 3 nodes"));
  axes[3] = {AxisMap::kNone, {}, {0.0, 0.0, kHalfPi}};
  EXPECT_TRUE(contains(messageOf(axes), "--axes phi: knot 2 does not increase"));
  axes[3] = {AxisMap::kNone, {}, {0.0, 0.5, 1.5}};
  EXPECT_TRUE(contains(messageOf(axes), "the last 90 (degrees)"));
  axes[3] = {};
  // the second node, which the floor must stay below, is the placement's
  axes[0] = {AxisMap::kNone, {}, {0.0, 5e-5, 1.0}};
  EXPECT_TRUE(contains(messageOf(axes), "--alpha-floor 0.0001: need 1e-05 up to (not including) 5e-05"));
}

}  // namespace
}  // namespace ltcfit
