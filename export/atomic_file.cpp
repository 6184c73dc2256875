#include "export/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>

#include "export/descriptor.h"
#include "export/temporary_file.h"

namespace ltcfit {
namespace {

namespace fs = std::filesystem;

fs::path folderOf(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

// Bytes to a device or pipe: there is nothing to rename.
void writeThrough(const std::string& path, std::string_view bytes) {
  internal::Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.get() < 0) internal::failWrite(path);
  internal::writeAll(file.get(), bytes, path);
  if (file.close() != 0) internal::failWrite(path);
}

// The descriptor that a path like /dev/stdout or /dev/fd/3 stands for, -1 for other paths. Bytes go through
// it: a file behind it belongs to whoever opened it, who may be in the middle of it.
int ownDescriptor(const std::string& path) {
  if (path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view prefix : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!path.starts_with(prefix)) continue;
    int fd = -1;
    const char* const end = path.data() + path.size();
    const auto parsed = std::from_chars(path.data() + prefix.size(), end, fd);
    if (parsed.ec == std::errc() && parsed.ptr == end && ::fcntl(fd, F_GETFD) >= 0) return fd;
  }
  return -1;
}

}  // namespace

void writeFileAtomically(const std::string& path, std::string_view bytes) {
  const int own = ownDescriptor(path);
  if (own >= 0) {
    std::fflush(stdout);
    return internal::writeAll(own, bytes, path);
  }
  std::error_code error;
  // the file that a link points to is replaced, not the link
  std::string target = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error).string() : path;
  if (error) target = path;
  struct stat old {};
  const bool exists = ::stat(target.c_str(), &old) == 0;
  if (exists && !S_ISREG(old.st_mode) && !S_ISDIR(old.st_mode)) return writeThrough(target, bytes);

  const std::optional<mode_t> mode = exists ? std::optional<mode_t>(old.st_mode & 07777) : std::nullopt;
  internal::replaceFile(target, bytes, mode, internal::TemporaryFiles());
}

bool isSameFile(const std::string& a, const std::string& b) {
  std::error_code error;
  const bool same = std::filesystem::equivalent(a, b, error);
  return !error && same && !isStream(a);
}

void checkWritable(const std::string& path) {
  std::error_code ignored;
  if (path.empty()) throw InputError("the output path is empty");
  if (ownDescriptor(path) >= 0) return;
  if (fs::is_directory(path, ignored)) throw InputError(path + ": is a folder, not a file");
  const fs::path folder = folderOf(path);
  if (!fs::is_directory(folder, ignored))
    throw InputError(path + ": the folder " + folder.string() + " does not exist");
  if (fs::exists(path, ignored)) {
    if (::access(path.c_str(), W_OK) != 0) throw InputError(path + ": cannot write: " + std::strerror(errno));
    if (!fs::is_regular_file(path, ignored)) return;  // a device or pipe is written to, not replaced
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
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

bool isStream(const std::string& path) {
  std::error_code ignored;
  return ownDescriptor(path) >= 0 || (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored));
}

}  // namespace ltcfit
