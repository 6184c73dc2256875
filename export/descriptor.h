// File descriptors, and writing to them. Internal to export/.
#pragma once

#include <string>
#include <string_view>

namespace ltcfit::internal {

/// A descriptor that closes itself.
class Descriptor {
 public:
  /// Takes what open() returned: below 0 for none.
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return fd_; }
  /// What ::close() returns: some file systems say only then that a write has failed.
  int close();

 private:
  int fd_;
};

/// Throws FileError: `path`, `what` and the reason that errno names.
[[noreturn]] void failWrite(const std::string& path, const char* what = "cannot write");

/// Writes all bytes, or throws FileError with `path` in its message.
void writeAll(int fd, std::string_view bytes, const std::string& path);

}  // namespace ltcfit::internal
