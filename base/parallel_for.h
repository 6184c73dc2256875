// The one parallel loop of the project: no other code opens an OpenMP region, which no exception may leave.
#pragma once

#ifdef _OPENMP
#include <omp.h>
#endif

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <type_traits>

namespace ltcfit {

/// Number of threads that `asked` stands for: itself, or as many as the machine has where it is 0 or less. A
/// build without OpenMP, as those of the fuzzed readers, has one.
inline int threadCount([[maybe_unused]] int asked) {
#ifdef _OPENMP
  return asked > 0 ? asked : omp_get_max_threads();
#else
  return 1;
#endif
}

/// Number of the calling thread within its loop, below threadCount().
inline std::size_t threadSlot() {
#ifdef _OPENMP
  return static_cast<std::size_t>(omp_get_thread_num());
#else
  return 0;
#endif
}

struct ParallelOptions {
  int threads = 0;  ///< as threadCount() takes them
  /// Iterations that a thread takes at a time. More than 1 saves time where an iteration takes microseconds;
  /// 1 is best where iterations take long or differ much.
  int chunk = 1;
};

/// Calls body(i), or body(i, slot), for all i below n, on some threads, in any order.
///
/// `slot` is below threadCount(options.threads), and no two bodies that run at the same time have the same:
/// scratch memory is indexed with it. Results must not depend on it, nor on the order of the calls. Sums are
/// made after the loop, in the order of i, and are then the same for any number of threads.
///
/// What the body returns, if anything, is called without arguments after it, one at a time: the place for
/// progress and for what is collected under a lock.
///
/// Exceptions come out of the loop once all threads have stopped. Where a body throws, later iterations are
/// given up and earlier ones end as ever: of several, the exception of the lowest i comes out, whatever the
/// number of threads. Where what a body returned throws, everything that has not begun is given up.
template <class Body>
void parallelFor(std::size_t n, ParallelOptions options, const Body& body) {
  const auto call = [&body](std::size_t i, std::size_t slot) {
    if constexpr (std::is_invocable_v<const Body&, std::size_t, std::size_t>) {
      return body(i, slot);
    } else {
      return body(i);
    }
  };
  std::atomic<std::size_t> end{n};  // iterations from here on are given up
  std::exception_ptr failure;
  std::size_t failed = n;
  bool cancelled = false;
  std::mutex mutex;  // of the three above, and of what bodies return
  const auto fail = [&](std::size_t i, bool all) {
    const std::lock_guard lock(mutex);
    cancelled = cancelled || all;
    if (i < failed) {
      failed = i;
      failure = std::current_exception();
    }
    end = cancelled ? 0 : failed;
  };
#pragma omp parallel for schedule(dynamic, options.chunk) num_threads(threadCount(options.threads))
  for (std::size_t i = 0; i < n; ++i) {
    if (i >= end.load(std::memory_order_relaxed)) continue;
    const std::size_t slot = threadSlot();
    bool bodyEnded = false;
    try {
      if constexpr (std::is_void_v<decltype(call(i, slot))>) {
        call(i, slot);
      } else {
        const auto after = call(i, slot);
        bodyEnded = true;
        const std::lock_guard lock(mutex);
        if (!cancelled) after();
      }
    } catch (...) {
      fail(i, bodyEnded);
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace ltcfit
