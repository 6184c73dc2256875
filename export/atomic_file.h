// Files that are either whole or not there.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace ltcfit {

/// Writing failed at run time (disk full, folder gone): the message names the file and the reason. Exit
/// code 1.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the user gave is not usable: a file that is not there or not what it claims to be, a path that cannot
/// be written. The message names the file and the field or reason. Exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes `bytes` to `path`, replacing what was there. Whoever kills the program at whatever moment finds the
/// old file or the new one, never a part: the bytes go to a file without a name (O_TMPFILE) that is linked
/// and renamed when complete and flushed. Where there are no such files they go to a new .ltcfit-RANDOM in
/// that folder, which a kill can leave behind; no two runs share a name. Permissions of a replaced file are
/// kept, what a link points to is replaced and not the link, and a device or pipe is written to. Throws
/// FileError and leaves nothing behind when anything fails, a full disk included.
void writeFileAtomically(const std::string& path, std::string_view bytes);

/// Throws InputError unless a file could be created at `path` (its folder exists and is writable, it is not a
/// folder itself): asked before a long run, not after it.
void checkWritable(const std::string& path);

/// Whether both paths lead to one file, by links too; false where either does not exist or is a stream.
bool isSameFile(const std::string& a, const std::string& b);

/// Whether bytes written to `path` go through it (a device, a pipe, /dev/stdout) instead of replacing a file.
bool isStream(const std::string& path);

/// The whole file; throws InputError, also for files of more than `limit` bytes.
std::string readFile(const std::string& path, std::uint64_t limit = std::uint64_t{1} << 32);

}  // namespace ltcfit
