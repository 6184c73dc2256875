#include "app/failure.h"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <string>

#include "app/exit_codes.h"
#include "base/parallel_for.h"
#include "base/refusal.h"
#include "export/atomic_file.h"

namespace ltcfit::app {
namespace {

template <class Exception>
Failure failureBy(const Exception& exception) {
  return failureOf(std::make_exception_ptr(exception));
}

TEST(Failure, BadInputIsTheUsers) {
  EXPECT_EQ(failureBy(InputError("t.json: cannot read")).exitCode, kExitBadInput);
  EXPECT_EQ(failureBy(InputError("t.json: cannot read")).message, "t.json: cannot read");
  EXPECT_EQ(failureBy(Refusal("--size 0x0")).exitCode, kExitBadInput);
  EXPECT_EQ(failureBy(Refusal("--size 0x0")).message, "--size 0x0");
}

TEST(Failure, WhatACallerDidWrongIsNotTheUsers) {
  for (const Failure& failure :
       {failureBy(std::invalid_argument("no chain")), failureBy(std::out_of_range("no chain")),
        failureBy(std::logic_error("no chain"))}) {
    EXPECT_EQ(failure.exitCode, kExitFailure);
    EXPECT_EQ(failure.message, "internal error: no chain");
  }
  // as a library of the language throws it
  try {
    (void)std::stoi("x");
  } catch (...) {
    EXPECT_EQ(failureOf(std::current_exception()).exitCode, kExitFailure);
  }
}

TEST(Failure, RunTimeFailuresKeepTheirMessage) {
  EXPECT_EQ(failureBy(FileError("t.json: cannot write")).exitCode, kExitFailure);
  EXPECT_EQ(failureBy(FileError("t.json: cannot write")).message, "t.json: cannot write");
  EXPECT_EQ(failureBy(std::bad_alloc()).message, "out of memory");
  EXPECT_EQ(failureBy(3).exitCode, kExitFailure);
}

TEST(Failure, AParallelLoopKeepsTheKind) {
  const auto thrown = [](const auto& exception) {
    try {
      parallelFor(8, {.threads = 2}, [&](std::size_t i) {
        if (i == 5) throw exception;
      });
    } catch (...) {
      return failureOf(std::current_exception()).exitCode;
    }
    return kExitOk;
  };
  EXPECT_EQ(thrown(Refusal("alpha")), kExitBadInput);
  EXPECT_EQ(thrown(std::invalid_argument("alpha")), kExitFailure);
}

}  // namespace
}  // namespace ltcfit::app
