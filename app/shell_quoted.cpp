#include "app/shell_quoted.h"

#include "app/paths.h"

namespace ltcfit::app {

std::string shellQuoted(std::string_view argument) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./:,=+@%";
  if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string_view::npos)
    return std::string(argument);
  std::string out = "'";
  for (const char c : argument) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      out += c;
    }
  }
  return out + "'";
}

std::string shellFileName(const std::string& path) {
  const std::string name = fileName(path);
  return shellQuoted(name.starts_with('-') ? "./" + name : name);
}

}  // namespace ltcfit::app
