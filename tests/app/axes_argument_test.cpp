// The option --axes: what it says, and what it refuses.
#include "app/axes_argument.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>
#include <vector>

#include "export/atomic_file.h"
#include "fit/table_plan.h"

namespace ltcfit::app {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

TEST(AxesArgument, NamesAreLayouts) {
  EXPECT_EQ(parseIsotropicAxes(kIsotropicAxes), IsotropicTableOptions{}.axes);
  EXPECT_EQ(parseAnisotropicAxes(kAnisotropicAxes), AnisotropicTableOptions{}.axes);
  EXPECT_EQ(parseIsotropicAxes("2016")[0].map, AxisMap::kLinear);
  EXPECT_EQ(parseIsotropicAxes("2016")[1].map, AxisMap::kSqrt);
  EXPECT_EQ(parseIsotropicAxes("best"), isotropicPlacement("best"));
  EXPECT_EQ(parseAnisotropicAxes("best"), anisotropicPlacement("best"));
}

TEST(AxesArgument, ListsChangeTheAxesThatTheyName) {
  const AnisotropicPlacement axes = parseAnisotropicAxes("theta=linear:0.3:-0.1,alpha=sqrt");
  EXPECT_EQ(axes[0], (NodePlacement{AxisMap::kSqrt}));
  EXPECT_EQ(axes[1], NodePlacement{});
  EXPECT_EQ(axes[2], (NodePlacement{AxisMap::kLinear, {0.3, -0.1}}));
  EXPECT_EQ(axes[3], NodePlacement{});
  // one coefficient: a; the others as in 2017
  const IsotropicPlacement iso = parseIsotropicAxes("alpha=linear:1e-1");
  EXPECT_EQ(iso[0], (NodePlacement{AxisMap::kSqrtOneMinusCos}));
  EXPECT_EQ(iso[1], (NodePlacement{AxisMap::kLinear, {0.1, 0.0}}));
}

TEST(AxesArgument, KnotsOfAnglesAreDegrees) {
  const AnisotropicPlacement axes = parseAnisotropicAxes("lambda=knots:0:0.1:1,phi=knots:0:30:90");
  EXPECT_EQ(axes[1], (NodePlacement{AxisMap::kNone, {}, {0.0, 0.1, 1.0}}));
  ASSERT_EQ(axes[3].knots.size(), 3u);
  EXPECT_DOUBLE_EQ(axes[3].knots[1], kHalfPi / 3.0);
  EXPECT_EQ(axes[3].knots[2], kHalfPi);  // exactly: the end of the range
}

std::string messageOf(const std::string& text) {
  try {
    parseAnisotropicAxes(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(AxesArgument, RefusesWhatItCannotRead) {
  const std::vector<std::pair<const char*, const char*>> cases{
      {"", "'' is neither 2022, best nor AXIS=MAP"},
      {"2017", "'2017' is neither"},
      {"best,alpha=sqrt", "'best' is neither"},
      {"alpha=sqrt,", "'' is neither"},
      {"alpha_x=sqrt", "no axis 'alpha_x' (alpha, lambda, theta, phi)"},
      {"=sqrt", "no axis ''"},
      {"alpha=", "'' is none of the maps"},
      {"alpha=cubic", "'cubic' is none of the maps linear, sqrt, sqrt-one-minus-cos and knots"},
      {"alpha=sqrt,theta=linear,alpha=linear", "alpha is given twice"},
      {"alpha=linear:0.1:0.1:0.1", "more than two coefficients"},
      {"alpha=linear:", "'' is not a number"},
      {"alpha=linear:0.1x", "'0.1x' is not a number"},
      {"alpha=linear:nan", "'nan' is not a number"},
      {"alpha=linear:1e999", "'1e999' is not a number"},
      {"alpha=knots:0:one:1", "'one' is not a number"},
      {"alpha = sqrt", "no axis 'alpha '"}};
  for (const auto& [text, message] : cases) {
    EXPECT_NE(messageOf(text).find(message), std::string::npos) << text << ": " << messageOf(text);
    EXPECT_EQ(messageOf(text).find("--axes '"), 0u) << text;
  }
}

}  // namespace
}  // namespace ltcfit::app
