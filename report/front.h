// Which of several choices no other beats in both cost and error.
#pragma once

#include <vector>

namespace ltcfit {

/// A choice: what it costs, how far off it is. Less is better in both.
struct CostAndError {
  double cost;
  double error;
};

/// Whether `a` is at least as cheap and at least as good as `b`, and one of the two strictly. An error that
/// is not finite is worse than any that is, and beats nothing.
bool beats(const CostAndError& a, const CostAndError& b);

/// For each choice whether none of the others beats it. Equal ones are on the front together; one whose error
/// is not finite never is.
std::vector<bool> paretoFront(const std::vector<CostAndError>& choices);

}  // namespace ltcfit
