#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include "base/diagnostics.h"

namespace ltcfit::app {

std::string progressText(std::string_view what, std::size_t done, std::size_t total, double elapsed) {
  const auto all = static_cast<double>(total);
  const double share = done < total ? static_cast<double>(done) / all : 1.0;
  std::string text = fmt::format("{}: {} of {} ({:.0f} %)", what, done, total, 100.0 * share);
  if (done > 0) text += fmt::format(", {:.0f} s left", elapsed * (1.0 - share) / share);
  return text;
}

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)), shown_(!quiet && ::isatty(STDERR_FILENO) != 0), start_(Clock::now()) {}

Progress::~Progress() {
  if (drawn_) diagnose("\r\x1b[K");
}

void Progress::update(std::size_t done, std::size_t total) {
  if (!shown_) return;
  const Clock::time_point now = Clock::now();
  if (drawn_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  diagnose("\r\x1b[K" + progressText(what_, done, total, elapsed));
}

}  // namespace ltcfit::app
