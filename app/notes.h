// What commands say besides their result.
#pragma once

#include <string_view>

namespace ltcfit::app {

enum class NotesTo {
  kStdout,  ///< where a failing write ends the command with exit code 1
  kStderr   ///< where stdout carries the data alone: what cannot be written is lost
};

void printNotes(NotesTo where, std::string_view text);

}  // namespace ltcfit::app
