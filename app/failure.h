// What an exception that nobody caught means to the user.
#pragma once

#include <exception>
#include <string>

namespace ltcfit::app {

struct Failure {
  std::string message;
  int exitCode;  ///< kExitBadInput or kExitFailure
};

/// InputError and Refusal are the user's bad input: kExitBadInput. All else is a failure; an error of logic,
/// as std::invalid_argument and std::out_of_range are, is one of the program itself, and its message says so.
Failure failureOf(const std::exception_ptr& exception);

}  // namespace ltcfit::app
