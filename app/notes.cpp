#include "app/notes.h"

#include <fmt/format.h>

#include <cstdio>

#include "base/diagnostics.h"

namespace ltcfit::app {

void printNotes(NotesTo where, std::string_view text) {
  if (where == NotesTo::kStderr) {
    diagnose(text);
  } else {
    fmt::print("{}", text);
  }
}

}  // namespace ltcfit::app
