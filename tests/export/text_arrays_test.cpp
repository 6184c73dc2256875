#include "export/text_arrays.h"

#include <gtest/gtest.h>

namespace ltcfit {
namespace {

TEST(TextArrays, ReadsCAndJavaScript) {
  const std::vector<TextArray> arrays = arraysOfText(
      "/* a = {1} is a comment's, and is read: no matter */\n"
      "static const float m[2][2] = {\n  {1.5e+00f, -2f}, // first = [9]\n  {3, /* 4 */ .5F}};\n"
      "const N = 7; if (x == 3) {}\n"
      "const LTC_1 = new Float32Array( [ 1, 2e-05, 7.91421e-31, - 3 ] ), b=[1,\n+2];\n"
      "float named[LTC_Size * LTC_Size][4] = { {1, 2, 3, 4} };\n");
  ASSERT_EQ(arrays.size(), 5u);
  EXPECT_EQ(arrays[1].name, "m");
  EXPECT_EQ(arrays[1].shape, (std::vector<std::size_t>{2, 2}));
  EXPECT_EQ(arrays[1].values, (std::vector<float>{1.5f, -2.0f, 3.0f, 0.5f}));
  EXPECT_EQ(arrays[2].name, "LTC_1");
  EXPECT_EQ(arrays[2].values, (std::vector<float>{1.0f, 2e-5f, 7.91421e-31f, -3.0f}));
  EXPECT_EQ(arrays[3].name, "b");
  EXPECT_EQ(arrays[3].values, (std::vector<float>{1.0f, 2.0f}));
  EXPECT_EQ(arrays[4].shape, (std::vector<std::size_t>{0, 4}));
}

TEST(TextArrays, LeavesOutWhatIsNoArrayOfNumbers) {
  for (const char* text :
       {"a = {1, x}", "a = {1, 2", "a = {}", "a = [1, nan]", "a = [1, inf]", "= [1]", "a = {\"1\"}",
        "a = {1e999}", "a = {1 2x}", "a = {--1}", "a = {-", "a = [", "a =", "=", ""}) {
    const std::vector<TextArray> arrays = arraysOfText(text);
    EXPECT_TRUE(arrays.empty()) << text;
  }
}

}  // namespace
}  // namespace ltcfit
