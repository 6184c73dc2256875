#include "app/progress.h"

#include <gtest/gtest.h>

namespace ltcfit::app {
namespace {

TEST(ProgressText, SaysWhatIsDoneAndWhatIsLeft) {
  EXPECT_EQ(progressText("fit", 1, 4, 2.0), "fit: 1 of 4 (25 %), 6 s left");
  EXPECT_EQ(progressText("fit", 4, 4, 2.0), "fit: 4 of 4 (100 %), 0 s left");
  EXPECT_EQ(progressText("score", 1, 3, 0.0), "score: 1 of 3 (33 %), 0 s left");
}

TEST(ProgressText, EstimatesNothingBeforeTheFirstIsDone) {
  EXPECT_EQ(progressText("fit", 0, 1, 0.0), "fit: 0 of 1 (0 %)");
  EXPECT_EQ(progressText("fit", 0, 1000, 3.0), "fit: 0 of 1000 (0 %)");
}

TEST(ProgressText, IsNeverInfiniteNorNegative) {
  for (std::size_t total = 0; total < 4; ++total) {
    for (std::size_t done = 0; done < 6; ++done) {
      for (const double elapsed : {0.0, 1e-9, 1e6}) {
        const std::string text = progressText("fit", done, total, elapsed);
        EXPECT_EQ(text.find("inf"), std::string::npos) << text;
        EXPECT_EQ(text.find("nan"), std::string::npos) << text;
        EXPECT_EQ(text.find('-'), std::string::npos) << text;
      }
    }
  }
}

}  // namespace
}  // namespace ltcfit::app
