#include "base/parallel_for.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace ltcfit {
namespace {

TEST(ParallelFor, CallsEachOnce) {
  for (const int threads : {0, 1, 2, 7}) {
    for (const int chunk : {1, 16}) {
      std::vector<int> calls(1000, 0);
      parallelFor(calls.size(), {.threads = threads, .chunk = chunk}, [&](std::size_t i) { ++calls[i]; });
      EXPECT_EQ(calls, std::vector<int>(1000, 1)) << threads << " threads, chunk " << chunk;
    }
  }
}

TEST(ParallelFor, OfNothingCallsNothing) {
  parallelFor(0, {}, [](std::size_t) { FAIL(); });
  parallelFor(0, {.threads = 3}, [](std::size_t, std::size_t) { return [] { FAIL(); }; });
}

TEST(ParallelFor, OneThreadGoesInOrder) {
  std::vector<std::size_t> order;
  parallelFor(100, {.threads = 1}, [&](std::size_t i, std::size_t slot) {
    EXPECT_EQ(slot, 0u);
    order.push_back(i);
    return [&, i] { EXPECT_EQ(order.back(), i); };
  });
  std::vector<std::size_t> expected(100);
  std::iota(expected.begin(), expected.end(), 0u);
  EXPECT_EQ(order, expected);
}

TEST(ParallelFor, NoTwoBodiesHaveOneSlot) {
  for (const int threads : {0, 1, 4}) {
    const auto slots = static_cast<std::size_t>(threadCount(threads));
    std::vector<std::atomic<int>> inside(slots);
    std::atomic<int> bad{0};
    parallelFor(64, {.threads = threads}, [&](std::size_t, std::size_t slot) {
      if (slot >= slots || ++inside[slot] != 1) ++bad;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      if (slot < slots) --inside[slot];
    });
    EXPECT_EQ(bad, 0) << threads << " threads";
  }
}

TEST(ParallelFor, WhatBodiesReturnIsCalledOneAtATime) {
  int inside = 0;
  int sum = 0;
  bool alone = true;
  parallelFor(200, {.threads = 4}, [&](std::size_t i) {
    return [&, i] {
      alone = alone && ++inside == 1;
      sum += static_cast<int>(i);
      std::this_thread::sleep_for(std::chrono::microseconds(20));
      --inside;
    };
  });
  EXPECT_TRUE(alone);
  EXPECT_EQ(sum, 199 * 200 / 2);
}

// The message of the exception that comes out of a loop.
template <class Body>
std::string thrownBy(std::size_t n, ParallelOptions options, const Body& body) {
  try {
    parallelFor(n, options, body);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "nothing";
}

TEST(ParallelFor, TheExceptionOfTheLowestComesOut) {
  for (const int threads : {1, 2, 5}) {
    for (const int chunk : {1, 8}) {
      std::vector<int> calls(300, 0);
      const std::string message =
          thrownBy(calls.size(), {.threads = threads, .chunk = chunk}, [&](std::size_t i) {
            ++calls[i];
            if (i == 40)
              std::this_thread::sleep_for(std::chrono::milliseconds(5));  // so that others are first
            if (i >= 40 && i % 2 == 0) throw std::runtime_error("body " + std::to_string(i));
          });
      EXPECT_EQ(message, "body 40") << threads << " threads, chunk " << chunk;
      for (std::size_t i = 0; i <= 40; ++i) EXPECT_EQ(calls[i], 1) << i;
      EXPECT_LT(std::accumulate(calls.begin(), calls.end(), 0), 300) << "the loop went on";
    }
  }
}

TEST(ParallelFor, WhatWasFinishedIsCollectedThoughABodyThrows) {
  std::vector<std::size_t> collected;
  const std::string message = thrownBy(100, {.threads = 3}, [&](std::size_t i) {
    if (i == 20) throw std::runtime_error("body 20");
    return [&, i] { collected.push_back(i); };
  });
  EXPECT_EQ(message, "body 20");
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(std::count(collected.begin(), collected.end(), i), 1) << i;
}

TEST(ParallelFor, AnExceptionOfWhatABodyReturnedEndsTheLoop) {
  for (const int threads : {1, 4}) {
    int after = 0;
    std::atomic<int> bodies{0};
    const std::string message = thrownBy(1000, {.threads = threads}, [&](std::size_t) {
      ++bodies;
      return [&] {
        if (++after == 10) throw std::runtime_error("cancelled");
      };
    });
    EXPECT_EQ(message, "cancelled");
    EXPECT_EQ(after, 10) << "called again after it had thrown";
    EXPECT_LT(bodies, 100);
  }
}

TEST(ParallelFor, ExceptionsOfAnyTypeComeOut) {
  EXPECT_THROW(parallelFor(10, {.threads = 3}, [](std::size_t) { throw 3; }), int);
}

TEST(ParallelFor, ALoopInALoop) {
  std::vector<std::vector<int>> calls(6, std::vector<int>(50, 0));
  parallelFor(calls.size(), {.threads = 3}, [&](std::size_t i) {
    parallelFor(calls[i].size(), {.threads = 3}, [&](std::size_t j) { ++calls[i][j]; });
  });
  EXPECT_EQ(calls, std::vector<std::vector<int>>(6, std::vector<int>(50, 1)));
  EXPECT_EQ(thrownBy(4, {.threads = 2},
                     [](std::size_t) {
                       parallelFor(4, {.threads = 2}, [](std::size_t) { throw std::runtime_error("inner"); });
                     }),
            "inner");
}

}  // namespace
}  // namespace ltcfit
