// A progress line with the time left, on stderr, only where someone is looking.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace ltcfit::app {

/// "WHAT: DONE of TOTAL (P %), S s left": the time left by the `elapsed` seconds that what is done took.
/// Without it before anything is done.
std::string progressText(std::string_view what, std::size_t done, std::size_t total, double elapsed);

class Progress {
 public:
  /// `what` names the work ("fit", "score"). Silent when `quiet`, or when stderr is not a terminal.
  Progress(std::string what, bool quiet);
  /// Clears the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// At most ten times a second.
  void update(std::size_t done, std::size_t total);

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool shown_;
  bool drawn_ = false;
  Clock::time_point start_;
  Clock::time_point last_;
};

}  // namespace ltcfit::app
