#pragma once

#include <atomic>
#include <cstddef>

namespace ltcfit::test {

/// The largest block asked for since it was last set to 0, by whomever: new, malloc, zstd, OpenEXR.
/// largest_allocation.cpp replaces malloc, or with LTCFIT_SANITIZED asks AddressSanitizer to tell.
extern std::atomic<std::size_t> largestAllocation;

}  // namespace ltcfit::test
