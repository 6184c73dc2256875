#include "report/front.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ltcfit {
namespace {

using Choices = std::vector<CostAndError>;

TEST(Front, KnownAnswer) {
  const Choices choices{{1.0, 5.0}, {2.0, 3.0}, {2.0, 4.0}, {3.0, 3.0},
                        {4.0, 1.0}, {4.0, 2.0}, {5.0, 1.0}, {0.5, 6.0}};
  EXPECT_EQ(paretoFront(choices), (std::vector<bool>{true, true, false, false, true, false, false, true}));
}

TEST(Front, EqualChoicesAreOnItTogether) {
  EXPECT_EQ(paretoFront({{1.0, 2.0}, {1.0, 2.0}}), (std::vector<bool>{true, true}));
  EXPECT_EQ(paretoFront({{1.0, 2.0}, {1.0, 2.0}, {1.0, 1.5}}), (std::vector<bool>{false, false, true}));
  EXPECT_EQ(paretoFront({{1.0, 2.0}}), (std::vector<bool>{true}));
  EXPECT_TRUE(paretoFront({}).empty());
}

TEST(Front, WhatFailedIsNeverOnIt) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(paretoFront({{0.1, infinity}, {0.2, std::nan("")}, {1.0, 1.0}}),
            (std::vector<bool>{false, false, true}));
  EXPECT_EQ(paretoFront({{0.1, infinity}}), (std::vector<bool>{false}));
}

TEST(Front, Beats) {
  const CostAndError a{1.0, 1.0};
  EXPECT_FALSE(beats(a, a));
  EXPECT_TRUE(beats(a, {1.0, 2.0}));
  EXPECT_TRUE(beats(a, {2.0, 1.0}));
  EXPECT_FALSE(beats(a, {0.5, 2.0}));
  EXPECT_FALSE(beats({2.0, 1.0}, a));
  EXPECT_TRUE(beats(a, {1.0, std::nan("")}));
  EXPECT_FALSE(beats({1.0, std::nan("")}, a));
}

}  // namespace
}  // namespace ltcfit
