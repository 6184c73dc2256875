// Files on their way to a name. Internal to export/.
#pragma once

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace ltcfit::internal {

/// ".ltcfit-" and 16 random hexadecimal digits: a name that no other run, container or machine that shares
/// the folder has. Throws FileError where the system has no random numbers.
std::string randomTemporaryName();

/// How temporary files are made; the defaults are what writeFileAtomically() uses.
struct TemporaryFiles {
  /// Name in the folder of the file to be replaced. A name that is taken is left alone and another one is
  /// asked for; after some hundred the write fails.
  std::function<std::string()> name = randomTemporaryName;
  /// Whether to write to a file without a name first (O_TMPFILE), where the file system has such files.
  bool unnamed = true;
};

/// writeFileAtomically() for paths that are regular files or nothing yet. `mode` is the permissions of the
/// file to be replaced.
void replaceFile(const std::string& path, std::string_view bytes, std::optional<mode_t> mode,
                 const TemporaryFiles& files);

}  // namespace ltcfit::internal
