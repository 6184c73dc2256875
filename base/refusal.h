// What a library says to a value that it does not take.
#pragma once

#include <stdexcept>

namespace ltcfit {

/// A value that may come from the user, of an option or in a file, is not usable. The message names the value
/// and what is allowed. Whoever knows the option or file catches it and adds the name; the program ends with
/// exit code
/// 2. A plain std::invalid_argument is a caller's bug, which no input can mend: exit code 1.
class Refusal : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace ltcfit
