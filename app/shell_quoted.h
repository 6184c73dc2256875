// Arguments in commands that a shell is to read again.
#pragma once

#include <string>
#include <string_view>

namespace ltcfit::app {

/// `argument` as a POSIX shell reads it back to the same bytes: as it is where it holds nothing that a shell
/// changes, else in single quotes.
std::string shellQuoted(std::string_view argument);

/// The last part of `path`, quoted: a name that says nothing of the machine. One that begins with '-' becomes
/// "./-NAME", else it would be read as an option.
std::string shellFileName(const std::string& path);

}  // namespace ltcfit::app
