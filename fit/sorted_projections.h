// Sorting projections with the index of the sample that each belongs to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ltcfit {

/// Sorts samples by their projection. Ties, and projections that differ by less than float32 resolves
/// relative to `centre`, come in the order of their index: the result is defined for every input.
class ProjectionSorter {
 public:
  /// Index of the sample at each rank, for up to 2^32 projections. `centre` near their middle keeps float32's
  /// digits for sharp lobes. The span is valid until the next call.
  std::span<const std::uint32_t> order(std::span<const double> projections, double centre);

 private:
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> order_;
};

}  // namespace ltcfit
