#include "export/descriptor.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "export/atomic_file.h"

namespace ltcfit::internal {

int Descriptor::close() {
  const int fd = fd_;
  fd_ = -1;
  return fd >= 0 ? ::close(fd) : 0;
}

void failWrite(const std::string& path, const char* what) {
  throw FileError(path + ": " + what + ": " + std::strerror(errno));
}

void writeAll(int fd, std::string_view bytes, const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) failWrite(path);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

}  // namespace ltcfit::internal
