// What goes to stderr: progress, warnings, and what a caller did wrong. None of it can end a run.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace ltcfit {

/// Writes `text` to stderr as it is. Where that fails (stderr is closed, its disk full, its terminal gone)
/// the text is lost, and nothing else happens.
inline void diagnose(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::clearerr(stderr);
}

/// Writes "ltcfit: `message`" and a newline, as diagnose() does.
inline void complain(std::string_view message) noexcept {
  std::fprintf(stderr, "ltcfit: %.*s\n", static_cast<int>(message.size()), message.data());
  std::clearerr(stderr);
}

/// Ends the program for a caller's bug: writes the values that were given, as printf formats them, and
/// aborts.
[[noreturn, gnu::format(printf, 1, 2)]] inline void abortWith(const char* format, ...) {
  std::va_list values;
  va_start(values, format);
  std::vfprintf(stderr, format, values);
  va_end(values);
  std::fputc('\n', stderr);
  std::abort();
}

}  // namespace ltcfit
