// A parallel loop whose iterations may throw.
#pragma once

#include <cstddef>
#include <exception>
#include <optional>

namespace ltcfit {

/// body(i) for all i below n, on some threads; what it returns is called, one at a time. The first exception
/// ends the loop and comes out of it (none may leave an OpenMP region).
template <class Body>
void parallelFor(std::size_t n, int threads, const Body& body) {
  std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (std::size_t i = 0; i < n; ++i) {
    bool stop = false;
#pragma omp critical(ltcfit_parallel_for)
    stop = failure != nullptr;
    if (stop) continue;
    std::optional<decltype(body(i))> after;
    std::exception_ptr thrown;
    try {
      after.emplace(body(i));
    } catch (...) {
      thrown = std::current_exception();
    }
#pragma omp critical(ltcfit_parallel_for)
    {
      try {
        if (thrown) std::rethrow_exception(thrown);
        if (!failure) (*after)();
      } catch (...) {
        if (!failure) failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace ltcfit
