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

TEST(TextArrays, TypesBetweenNameAndNumbers) {
  for (const char* text :
       {"const a: number[] = [1, 2]", "a: readonly number[]=[1, 2] as const",
        "a!: Float32Array = Float32Array.of(1, 2)", "a = new Float32Array(\n[1, 2])",
        "pub const a: [f32; 2] = [1.0_f32, 2f32];", "a: &'static [f64] = &[1., 2.]",
        "ushort[] a = new ushort[2] { 0x1, 0x0002 };", "var a = new float[] {1f, 2f}", "\"a\": [1, 2]",
        "{a: [1, 2]}", "'a' : [1, 2,]", "a = vec![1, 2]", "std::array<float, 2> a = {{1, 2}}",
        "private: float a[2] = {1, 2}", "a: Vec<f32> = Vec::from([1, 2])", "a = Object.freeze([1u, 2U])"}) {
    const std::vector<TextArray> arrays = arraysOfText(text);
    ASSERT_EQ(arrays.size(), 1u) << text;
    EXPECT_EQ(arrays[0].name, "a") << text;
    EXPECT_EQ(arrays[0].values, (std::vector<float>{1.0f, 2.0f})) << text;
    EXPECT_LE(arrays[0].shape.size(), 1u) << text;
  }
}

TEST(TextArrays, ShapeByNesting) {
  const auto shapeOf = [](const char* text) { return arraysOfText(text).at(0).shape; };
  EXPECT_EQ(shapeOf("a = [[1, 2, 3], [4, 5, 6]]"), (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(shapeOf("a = [[[1], [2]], [[3], [4]], [[5], [6]]]"), (std::vector<std::size_t>{3, 2, 1}));
  EXPECT_EQ(shapeOf("a = {{{1, 2}, {3, 4}}}"), (std::vector<std::size_t>{2, 2}));
  for (const char* text : {"a = [1, 2]", "a = {{1, 2}}", "a = [[1, 2], [3]]", "a = [[1, 2], 3, 4]",
                           "a = [1, [2, 3]]", "a = [[[[[[[[[[1, 2], [3, 4]]]]]]]]]]"}) {
    EXPECT_TRUE(shapeOf(text).empty()) << text;
  }
}

TEST(TextArrays, TellsWhereAnArrayBroke) {
  std::vector<DamagedArray> damaged;
  EXPECT_TRUE(arraysOfText("a = [1, 2, nan, 4]; b = {1, 0x10000}; c = [1, 2", &damaged).empty());
  ASSERT_EQ(damaged.size(), 3u);
  EXPECT_EQ(damaged[0].numbers, 2u);
  EXPECT_EQ(damaged[0].found, "nan, 4]; b =");
  EXPECT_EQ(damaged[1].found, "0x10000}; c ");
  EXPECT_EQ(damaged[2].found, "");
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
