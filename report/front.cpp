#include "report/front.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ltcfit {

bool beats(const CostAndError& a, const CostAndError& b) {
  if (!std::isfinite(a.error)) return false;
  const double error = std::isfinite(b.error) ? b.error : std::numeric_limits<double>::infinity();
  return a.cost <= b.cost && a.error <= error && (a.cost < b.cost || a.error < error);
}

std::vector<bool> paretoFront(const std::vector<CostAndError>& choices) {
  std::vector<bool> front;
  for (const CostAndError& c : choices) {
    front.push_back(std::isfinite(c.error) &&
                    std::none_of(choices.begin(), choices.end(),
                                 [&](const CostAndError& other) { return beats(other, c); }));
  }
  return front;
}

}  // namespace ltcfit
