#include "export/text_arrays.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <system_error>

namespace ltcfit {
namespace {

constexpr std::size_t kMaxDimensions = 8;
constexpr std::size_t kMaxDimensionLength = 64;  // with its brackets

bool isWord(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$';
}
bool isSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

// Position behind blanks and comments.
std::size_t skipBlanks(std::string_view text, std::size_t at) {
  while (at < text.size()) {
    if (isSpace(text[at])) {
      ++at;
    } else if (text.substr(at, 2) == "/*") {
      const std::size_t end = text.find("*/", at + 2);
      at = end == std::string_view::npos ? text.size() : end + 2;
    } else if (text.substr(at, 2) == "//") {
      at = std::min(text.find('\n', at), text.size());
    } else {
      break;
    }
  }
  return at;
}

// What stands before the '=' at `equals`: a name, and its dimensions in brackets.
bool readName(std::string_view text, std::size_t equals, TextArray& array) {
  std::size_t end = equals;
  while (end > 0 && isSpace(text[end - 1])) --end;
  while (end > 0 && text[end - 1] == ']') {
    // no further back than a dimension is long: every ']' of a hostile text would be searched to the start
    const std::size_t earliest = end - std::min(end, kMaxDimensionLength);
    const std::size_t offset = text.substr(earliest, end - earliest).rfind('[');
    if (offset == std::string_view::npos || array.shape.size() == kMaxDimensions) return false;
    const std::size_t open = earliest + offset;
    // a named constant instead of a number: 0, not known
    std::size_t dimension = 0;
    const char* const close = text.data() + end - 1;
    const auto [last, error] = std::from_chars(text.data() + open + 1, close, dimension);
    if (error != std::errc() || last != close) dimension = 0;
    array.shape.insert(array.shape.begin(), dimension);
    end = open;
  }
  std::size_t start = end;
  while (start > 0 && isWord(text[start - 1])) --start;
  array.name = text.substr(start, end - start);
  return !array.name.empty();
}

// Numbers between the bracket at `at` and the one that closes it. Moves `at` behind what was read.
bool readNumbers(std::string_view text, std::size_t& at, std::vector<float>& values) {
  std::size_t depth = 0;
  for (;;) {
    at = skipBlanks(text, at);
    if (at >= text.size()) return false;
    const char c = text[at];
    if (c == '[' || c == '{') {
      ++depth;
      ++at;
    } else if (c == ']' || c == '}') {
      ++at;
      if (--depth == 0) return true;
    } else if (c == ',') {
      ++at;
    } else {
      // a sign may stand apart: "- 4.5e-07"
      const bool negative = c == '-';
      if (c == '+' || negative) at = skipBlanks(text, at + 1);
      if (at >= text.size() || text[at] == '-') return false;
      float value = 0.0f;
      const auto [last, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
      if (last == text.data() + at) return false;
      // too small for a float32 is 0 or subnormal; too large is infinite, and no table's number
      if (error == std::errc::result_out_of_range)
        value = std::strtof(std::string(text.data() + at, last).c_str(), nullptr);
      if (!std::isfinite(value)) return false;
      values.push_back(negative ? -value : value);
      at = static_cast<std::size_t>(last - text.data());
      if (at < text.size() && (text[at] == 'f' || text[at] == 'F')) ++at;
      if (at < text.size() && isWord(text[at])) return false;
    }
  }
}

}  // namespace

std::vector<TextArray> arraysOfText(std::string_view text, std::vector<std::string>* damaged) {
  std::vector<TextArray> arrays;
  for (std::size_t at = 0; (at = text.find('=', at)) != std::string_view::npos;) {
    const std::size_t equals = at++;
    // what is skipped here is not searched again: a comment without end would be, once for each '=' in it
    at = skipBlanks(text, at);
    // "new Float32Array([" and the like stand between
    std::size_t open = at;
    while (open < text.size() && open - at < 64 &&
           (isWord(text[open]) || isSpace(text[open]) || text[open] == '('))
      ++open;
    if (open >= text.size() || (text[open] != '[' && text[open] != '{')) continue;
    // a shader's vec4[4096](..) has its numbers elsewhere
    if (open > at && isWord(text[open - 1])) continue;
    TextArray array;
    if (!readName(text, equals, array)) continue;
    at = open;
    const bool whole = readNumbers(text, at, array.values);
    if (array.values.empty()) continue;
    if (whole) {
      arrays.push_back(std::move(array));
    } else if (damaged != nullptr) {
      damaged->push_back(std::move(array.name));
    }
  }
  return arrays;
}

}  // namespace ltcfit
