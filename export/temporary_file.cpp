#include "export/temporary_file.h"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <filesystem>

#include "export/atomic_file.h"
#include "export/descriptor.h"

namespace ltcfit::internal {
namespace {

namespace fs = std::filesystem;

constexpr int kTries = 128;  // of 2^64 names: one is enough, unless something is wrong

fs::path parentOf(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

// Gives the complete, unnamed file a name that nothing has; false with errno where that is not possible
// (EEXIST: something has it; others: no /proc).
bool linkUnnamed(const Descriptor& file, const std::string& name) {
  const std::string self = "/proc/self/fd/" + std::to_string(file.get());
  return ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

// A new name of the folder could be lost with the power, although the file's bytes are on the disk.
void flushFolder(const std::string& path) {
  const Descriptor folder(::open(parentOf(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.get() < 0) return;  // may be written to, but not read
  // some file systems have no such thing
  if (::fsync(folder.get()) != 0 && errno != EINVAL && errno != ENOTSUP && errno != EROFS)
    failWrite(path, "cannot flush its folder");
}

class Replacement {
 public:
  Replacement(const std::string& path, std::string_view bytes, std::optional<mode_t> mode,
              const TemporaryFiles& files)
      : path_(path), bytes_(bytes), mode_(mode), files_(files), folder_(parentOf(path)) {}

  void run() {
    if (!files_.unnamed || !throughUnnamed()) throughNamed();
    flushFolder(path_);
  }

 private:
  std::string nextName() const { return (folder_ / files_.name()).string(); }

  void fill(const Descriptor& file) const {
    writeAll(file.get(), bytes_, path_);
    if (mode_ && ::fchmod(file.get(), *mode_) != 0) failWrite(path_);
    if (::fsync(file.get()) != 0) failWrite(path_);
  }

  // `name` is ours: whatever fails, it goes.
  void rename(const std::string& name) const {
    if (::rename(name.c_str(), path_.c_str()) == 0) return;
    const int reason = errno;
    ::unlink(name.c_str());
    errno = reason;
    failWrite(path_);
  }

  // False where the file system has no files without a name, or none that can be given one.
  bool throughUnnamed() const {
    const Descriptor file(::open(folder_.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666));
    if (file.get() < 0) return false;
    fill(file);
    // where there is nothing to replace, nothing else is ever to be seen
    if (linkUnnamed(file, path_)) return true;
    for (int i = 0; i < kTries; ++i) {
      const std::string name = nextName();
      if (linkUnnamed(file, name)) {
        rename(name);
        return true;
      }
      if (errno != EEXIST) return false;
    }
    failWrite(path_);
  }

  void throughNamed() const {
    for (int i = 0; i < kTries; ++i) {
      const std::string name = nextName();
      const Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
      if (file.get() < 0 && errno == EEXIST) continue;
      if (file.get() < 0) failWrite(path_);
      try {
        fill(file);
      } catch (...) {
        ::unlink(name.c_str());
        throw;
      }
      return rename(name);
    }
    failWrite(path_);
  }

  const std::string& path_;
  std::string_view bytes_;
  std::optional<mode_t> mode_;
  const TemporaryFiles& files_;
  fs::path folder_;
};

}  // namespace

std::string randomTemporaryName() {
  std::uint64_t number = 0;
  while (::getrandom(&number, sizeof number, 0) != sizeof number)
    if (errno != EINTR) failWrite("temporary file", "no random name");
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), ".ltcfit-%016llx", static_cast<unsigned long long>(number));
  return name.data();
}

void replaceFile(const std::string& path, std::string_view bytes, std::optional<mode_t> mode,
                 const TemporaryFiles& files) {
  Replacement(path, bytes, mode, files).run();
}

}  // namespace ltcfit::internal
