#include "export/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace ltcfit {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw FileError(path + ": " + what + ": " + std::strerror(errno));
}

fs::path folderOf(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

// A descriptor that closes itself, and a temporary name that goes away unless it was renamed.
class PendingFile {
 public:
  explicit PendingFile(std::string target) : target_(std::move(target)) {
    name_ = target_ + ".tmp-" + std::to_string(::getpid());
    fd_ = ::open(folderOf(target_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (fd_ >= 0) return;
    fd_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd_ < 0) fail(target_, "cannot write");
    named_ = true;
  }
  ~PendingFile() {
    if (fd_ >= 0) ::close(fd_);
    if (named_) ::unlink(name_.c_str());
  }
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail(target_, "cannot write");
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
  }

  void commit() {
    if (::fsync(fd_) != 0) fail(target_, "cannot write");
    if (!named_) {
      const std::string self = "/proc/self/fd/" + std::to_string(fd_);
      ::unlink(name_.c_str());  // left by a killed process of the same number
      if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name_.c_str(), AT_SYMLINK_FOLLOW) != 0) {
        fail(target_, "cannot write");
      }
      named_ = true;
    }
    const int fd = fd_;
    fd_ = -1;
    if (::close(fd) != 0) fail(target_, "cannot write");
    if (::rename(name_.c_str(), target_.c_str()) != 0) fail(target_, "cannot write");
    named_ = false;
  }

 private:
  std::string target_;
  std::string name_;
  int fd_ = -1;
  bool named_ = false;
};

}  // namespace

void writeFileAtomically(const std::string& path, std::string_view bytes) {
  PendingFile file(path);
  file.write(bytes);
  file.commit();
}

void checkWritable(const std::string& path) {
  std::error_code ignored;
  if (path.empty()) throw InputError("the output path is empty");
  if (fs::is_directory(path, ignored)) throw InputError(path + ": is a folder, not a file");
  const fs::path folder = folderOf(path);
  if (!fs::is_directory(folder, ignored))
    throw InputError(path + ": the folder " + folder.string() + " does not exist");
  if (::access(folder.c_str(), W_OK) != 0)
    throw InputError(path + ": cannot write into its folder: " + std::strerror(errno));
}

std::string readFile(const std::string& path, std::uint64_t limit) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw InputError(path + ": is a folder, not a file");
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) throw InputError(path + ": cannot read: " + std::strerror(errno));
  std::string bytes;
  char block[65536];
  std::size_t n = 0;
  while ((n = std::fread(block, 1, sizeof block, file)) > 0) {
    bytes.append(block, n);
    if (bytes.size() > limit) break;
  }
  const bool bad = std::ferror(file) != 0;
  const int reason = errno;
  std::fclose(file);
  if (bad) throw InputError(path + ": cannot read: " + std::strerror(reason));
  if (bytes.size() > limit) throw InputError(path + ": larger than " + std::to_string(limit) + " bytes");
  return bytes;
}

}  // namespace ltcfit
