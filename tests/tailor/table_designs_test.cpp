#include "tailor/table_designs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tailor/fetch_check.h"
#include "tailor/tailored_table.h"
#include "tests/tailor/support.h"

namespace ltcfit {
namespace {

constexpr double kFloor = 1e-4;

TEST(AxisRange, MarginsStayInTheDomain) {
  const auto ranges = axisRanges(test::isotropicLobes(0.3, 0.7), kFloor, 0.02);
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_EQ(ranges[0].name, "theta");
  EXPECT_NEAR(std::sqrt(ranges[1].low), 0.28, 1e-12);
  EXPECT_NEAR(std::sqrt(ranges[1].high), 0.72, 1e-12);
  const auto wide = axisRanges(test::isotropicLobes(0.0, 1.0), kFloor, 0.02);
  EXPECT_EQ(wide[1].low, kFloor);
  EXPECT_EQ(wide[1].high, 1.0);
  const auto one = axisRanges(test::isotropicLobes(0.4, 0.4, 1), kFloor, 0.02);
  EXPECT_TRUE(one[1].isSingle());
  EXPECT_EQ(one[1].axis(1).values, std::vector<double>{0.4 * 0.4});

  const auto four = axisRanges(test::anisotropicLobes(), kFloor, 0.05);
  ASSERT_EQ(four.size(), 4u);
  EXPECT_NEAR(four[1].low, 0.35, 1e-12);
  EXPECT_NEAR(four[1].high, 0.65, 1e-12);
  // the axes are a table's
  std::vector<Axis> axes;
  for (const AxisRange& r : four) axes.push_back(r.axis(3, {0.2, 0.1}));
  TableInfo info;
  info.axes = axes;
  info.channels = {"m00", "m11", "m22"};
  EXPECT_NO_THROW(Table(info, std::vector<float>(81 * 3, 1.0f)));
  // one node sits between the ends
  EXPECT_GT(four[0].axis(1).values[0], four[0].low);
  EXPECT_LT(four[0].axis(1).values[0], four[0].high);
}

struct Designed {
  LobeDistribution distribution;
  InterpolationModelOptions options;
  const InterpolationModel& model;
  const TableDesigns& designs;
};

void theFrontHasLessErrorForMoreNodes(const Designed& d) {
  const auto& front = d.designs.front();
  ASSERT_GT(front.size(), 20u);
  EXPECT_EQ(front.front().nodeCount(), 1u);
  for (std::size_t i = 1; i < front.size(); ++i) {
    EXPECT_GT(front[i].nodeCount(), front[i - 1].nodeCount());
    EXPECT_LT(front[i].error, front[i - 1].error);
  }
  EXPECT_EQ(d.designs.design(front[10].nodes).error, front[10].error);
  EXPECT_DOUBLE_EQ(d.model.error(d.designs.axes(front[10])), front[10].error);
}

void anAxisIsExactWhereItsNodesAre(const Designed& d) {
  // an axis with a node at every fit's alpha shifts nothing that lies there
  const AxisRange& alpha = d.model.ranges()[1];
  const auto shifts = d.model.shifts(1, alpha.axis(64));
  const auto coarse = d.model.shifts(1, alpha.axis(3));
  EXPECT_LT(shifts.norm(), 0.01 * coarse.norm());  // linear interpolation: (2 / 63)^2 and rounding
}

void warpsAreWorthTheirCost(const Designed& d) {
  for (std::size_t axis : {0u, 1u}) {
    std::vector<std::size_t> nodes{20, 20};
    nodes[axis] = 6;
    const TableDesign chosen = d.designs.design(nodes);
    std::vector<Axis> axes = d.designs.axes(chosen);
    EXPECT_TRUE(isMonotone(axes[axis].warp));
    axes[axis] = d.model.ranges()[axis].axis(6);
    EXPECT_LE(chosen.error, d.model.error(axes) * (1.0 + 1e-9));
  }
}

void predictionsComeNearMeasurements(const Designed& d) {
  const FetchCheck check(d.distribution, 128, d.options, 99);
  for (const std::vector<std::size_t>& nodes :
       {std::vector<std::size_t>{4, 3}, std::vector<std::size_t>{8, 4}, std::vector<std::size_t>{14, 6}}) {
    const TableDesign design = d.designs.design(nodes);
    const auto table = fitAxes(d.designs.axes(design), true, {"norm", "fresnel"}, d.options);
    ASSERT_TRUE(table.has_value());
    const FetchError measured = check.measure(shippedTable(*table, Precision::kHalf));
    EXPECT_EQ(measured.singular, 0u);
    // other look-ups, second order, rounding, the noise of 64 points
    EXPECT_GT(measured.mean, 0.65 * design.error) << nodes[0];
    EXPECT_LT(measured.mean, 1.6 * design.error) << nodes[0];
  }
}

void theFullTableIsPredictedBeyondTheRange(const Designed& d) {
  const double full = d.model.error(fullAxes(true, kFloor));
  EXPECT_GT(full, 0.0);
  EXPECT_LT(full, d.designs.design({16, 8}).error);
}

TEST(TableDesigns, PredictionsComeNearForMirrorsToo) {
  LobeDistribution distribution = test::isotropicLobes(0.02, 0.02, 1);
  const InterpolationModelOptions options = test::quickModel(true);
  const InterpolationModel model(distribution, axisRanges(distribution, kFloor, 0.01), options);
  const TableDesigns designs(model);
  const FetchCheck check(distribution, 128, options, 99);
  for (std::size_t nodes : {8u, 24u}) {
    const TableDesign design = designs.design({nodes, 1});
    const auto table = fitAxes(designs.axes(design), true, {"norm"}, options);
    ASSERT_TRUE(table.has_value());
    // within two and a half: shifts are beyond the lobe's own width
    const double measured = check.measure(shippedTable(*table, Precision::kHalf)).mean;
    EXPECT_GT(measured, 0.4 * design.error) << nodes;
    EXPECT_LT(measured, 2.5 * design.error) << nodes;
  }
}

TEST(FetchError, NothingMeasuredIsNotWithinAnything) {
  EXPECT_FALSE(FetchError{}.isWithin(1.0));
  const LobeDistribution distribution = test::isotropicLobes(0.5, 0.5, 1);
  const FetchCheck check(distribution, 8, test::quickModel(true), 5);
  // a table whose look-ups have no inverse
  TableInfo info;
  info.axes = {singleNodeAxis("theta", "rad", 0.5), singleNodeAxis("alpha", "1", 0.25)};
  info.channels = {"m00", "m11", "m22", "norm"};
  const FetchError error = check.measure(Table(info, {0.0f, 1.0f, 1.0f, 1.0f}));
  EXPECT_EQ(error.singular, 8u);
  EXPECT_TRUE(std::isinf(error.mean));
  EXPECT_FALSE(error.isWithin(1e9));
}

// One model for all: it takes a thousand fits.
TEST(TableDesigns, OfAnIsotropicRange) {
  const LobeDistribution distribution = test::isotropicLobes(0.3, 0.7);
  InterpolationModelOptions options = test::quickModel(true);
  options.points = 64;
  const InterpolationModel model(distribution, axisRanges(distribution, kFloor, 0.01), options);
  const TableDesigns designs(model);
  const Designed d{distribution, options, model, designs};
  theFrontHasLessErrorForMoreNodes(d);
  anAxisIsExactWhereItsNodesAre(d);
  warpsAreWorthTheirCost(d);
  predictionsComeNearMeasurements(d);
  theFullTableIsPredictedBeyondTheRange(d);
}

TEST(TableDesigns, SingleValuesHaveOneNode) {
  LobeDistribution d;
  d.isotropic = false;
  d.lobes = {{0.3, 0.15, 1.0, 1.0, 1.0}};
  InterpolationModelOptions options = test::quickModel(false);
  options.points = 4;
  options.lineFits = 5;
  const InterpolationModel model(d, axisRanges(d, kFloor, 0.01), options);
  const TableDesigns designs(model);
  EXPECT_EQ(designs.largest(0), 1u);
  EXPECT_EQ(designs.largest(1), 1u);
  EXPECT_EQ(designs.largest(2), TableDesigns::kLargestAnisotropic);
  for (const TableDesign& design : designs.front()) {
    EXPECT_EQ(design.nodes[0], 1u);
    EXPECT_EQ(design.nodes[1], 1u);
  }
  EXPECT_LT(designs.front().back().error, 0.1 * designs.front().front().error);
}

}  // namespace
}  // namespace ltcfit
