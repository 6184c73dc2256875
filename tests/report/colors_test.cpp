#include "report/colors.h"

#include <gtest/gtest.h>

namespace ltcfit {
namespace {

TEST(Colors, EndsMiddlesAndWhatIsOutside) {
  EXPECT_EQ(densityColor(0.0), (Rgb{68, 1, 84}));
  EXPECT_EQ(densityColor(1.0), (Rgb{253, 231, 37}));
  EXPECT_EQ(densityColor(0.5), (Rgb{33, 145, 140}));
  EXPECT_EQ(densityColor(7.0), densityColor(1.0));
  EXPECT_EQ(differenceColor(0.0), (Rgb{242, 242, 240}));
  EXPECT_EQ(differenceColor(-2.0), (Rgb{27, 79, 156}));
  EXPECT_EQ(differenceColor(0.25), (Rgb{242, 204, 165}));  // half way from neutral to the light orange
}

}  // namespace
}  // namespace ltcfit
