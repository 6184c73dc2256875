#include "report/pareto_entries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/angles.h"

namespace ltcfit {

std::vector<LobeParameters> paretoEntries(TableKind kind, std::size_t count) {
  // Ranks of the additive recurrence with the root of x^5 = x + 1 (the plastic number's sequence in four
  // dimensions): any first few of them are spread.
  constexpr double kRoot = 1.1673039782614187;
  constexpr std::size_t kDimensions = 4;
  std::array<std::vector<double>, kDimensions> coordinates;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    const double step = std::pow(kRoot, -static_cast<double>(d + 1));
    std::vector<double> position(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double x = 0.5 + step * static_cast<double>(i + 1);
      position[i] = x - std::floor(x);
    }
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return position[a] < position[b]; });
    coordinates[d].resize(count, 0.5);
    for (std::size_t rank = 0; rank < count && count > 1; ++rank)
      coordinates[d][order[rank]] = static_cast<double>(rank) / static_cast<double>(count - 1);
  }

  const bool iso = kind == TableKind::kIsotropic;
  const auto squareBetween = [](double low, double u) {
    const double root = low + u * (1.0 - low);
    return root * root;
  };
  std::vector<LobeParameters> entries;
  for (std::size_t i = 0; i < count; ++i) {
    const double alpha = squareBetween(iso ? 0.05 : 0.1, coordinates[0][i]);
    const double theta = kHalfPi * coordinates[1][i];
    if (iso) {
      entries.push_back({alpha, alpha, theta, 0.0});
    } else {
      entries.push_back(
          {alpha, alpha * squareBetween(0.1, coordinates[2][i]), theta, kHalfPi * coordinates[3][i]});
    }
  }
  return entries;
}

}  // namespace ltcfit
