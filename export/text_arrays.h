// Arrays of numbers in source text: what C headers and JavaScript modules hold of a table.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ltcfit {

struct TextArray {
  std::string name;
  std::vector<std::size_t>
      shape;  ///< as declared behind the name (C), 0 for what is no number; empty in JavaScript
  std::vector<float> values;  ///< in the order of the text, nesting removed
};

/// Every `NAME = [..]`, `NAME[n]..[m] = {..}` of numbers in a text, comments inside of it skipped. An
/// initialiser with anything else in it is left out; where it began with a number, the name goes to
/// `damaged`: cut off, or a number that is none any more. Takes any bytes and ends after one pass over them.
std::vector<TextArray> arraysOfText(std::string_view text, std::vector<std::string>* damaged = nullptr);

}  // namespace ltcfit
