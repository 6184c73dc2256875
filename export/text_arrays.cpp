#include "export/text_arrays.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <system_error>

namespace ltcfit {
namespace {

constexpr std::size_t kMaxDimensions = 8;
// What stands between a name and its numbers is no longer than this; a hostile text is searched no further.
constexpr std::size_t kMaxDimensionLength = 64;  // with its brackets
constexpr std::size_t kMaxAnnotation = 128;      // a type behind a name
constexpr std::size_t kMaxConstructor = 64;      // "new Float32Array(" and the like
constexpr std::size_t kFoundLength = 12;

bool isWord(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$';
}
bool isSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}
bool isOneOf(char c, std::string_view set) {
  return set.find(c) != std::string_view::npos;
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

std::size_t trimmed(std::string_view text, std::size_t end) {
  while (end > 0 && isSpace(text[end - 1])) --end;
  return end;
}

// The word that ends at `end`, maybe in quotes or with a mark of TypeScript behind it.
std::string_view wordBefore(std::string_view text, std::size_t end) {
  end = trimmed(text, end);
  if (end > 0 && isOneOf(text[end - 1], "\"'?!")) --end;
  std::size_t start = end;
  while (start > 0 && isWord(text[start - 1])) --start;
  return text.substr(start, end - start);
}

// The ':' between a name and its type, for an '=' behind both; npos where there is none.
std::size_t annotationBefore(std::string_view text, std::size_t equals) {
  constexpr std::array<std::string_view, 4> kLabels{"public", "private", "protected", "default"};
  std::size_t depth = 0;
  for (std::size_t i = equals; i > 0 && equals - i < kMaxAnnotation;) {
    const char c = text[--i];
    if (isOneOf(c, "])>")) {
      ++depth;
    } else if (isOneOf(c, "[(<")) {
      if (depth == 0) break;
      --depth;
    } else if (depth > 0) {
      continue;
    } else if (isOneOf(c, ";{},=\n")) {
      break;
    } else if (c == ':') {
      if (i > 0 && text[i - 1] == ':') {
        --i;
        continue;
      }
      const std::string_view word = wordBefore(text, i);
      return std::find(kLabels.begin(), kLabels.end(), word) == kLabels.end() ? i : std::string_view::npos;
    }
  }
  return std::string_view::npos;
}

// What stands before the '=' or ':' at `separator`: a name, and its type or its dimensions in brackets.
bool readName(std::string_view text, std::size_t separator, TextArray& array) {
  array.isMember = text[separator] == ':';
  const std::size_t colon = array.isMember ? separator : annotationBefore(text, separator);
  if (colon != std::string_view::npos) {
    array.name = wordBefore(text, colon);
    return !array.name.empty();
  }
  std::size_t end = trimmed(text, separator);
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
  array.name = wordBefore(text, end);
  return !array.name.empty();
}

// Where the numbers behind a separator open; npos where none do.
std::size_t openingOf(std::string_view text, std::size_t at) {
  const std::size_t end = std::min(text.size(), at + kMaxConstructor);
  std::size_t open = at;
  for (; open < end && (isWord(text[open]) || isSpace(text[open]) || isOneOf(text[open], "(.:&!<>"));
       ++open) {
    if (text[open] == '(' && text.substr(at, open - at).ends_with(".of")) return open;
  }
  if (open >= end || !isOneOf(text[open], "[{")) return std::string_view::npos;
  if (open == at || text[open] == '{' || !isWord(text[open - 1])) return open;
  // "new ushort[16384] {"; a shader's vec4[4096](..) has its numbers elsewhere
  const std::size_t close = text.substr(0, std::min(text.size(), open + kMaxDimensionLength)).find(']', open);
  if (close == std::string_view::npos) return close;
  open = close + 1;
  while (open < text.size() && open - close < kMaxConstructor && isSpace(text[open])) ++open;
  return open < text.size() && text[open] == '{' ? open : std::string_view::npos;
}

// The lengths of nested brackets, which have to agree.
class Nesting {
 public:
  void open() {
    if (depth_ > 0) count();
    if (++depth_ > kMaxDimensions) regular_ = false;
  }
  void number() {
    if (leaf_ == 0) leaf_ = depth_;
    regular_ = regular_ && leaf_ == depth_;
    count();
  }
  /// Returns whether the outermost bracket was closed.
  bool close() {
    const std::size_t d = depth_--;
    if (d > kMaxDimensions) return false;
    if (length_[d - 1] == 0) length_[d - 1] = count_[d - 1];
    regular_ = regular_ && length_[d - 1] == count_[d - 1];
    count_[d - 1] = 0;
    return d == 1;
  }
  /// Empty for a flat list. Outer brackets around one inner one say nothing: std::array has them.
  std::vector<std::size_t> shape() const {
    if (!regular_) return {};
    std::size_t first = 0;
    while (first < leaf_ && length_[first] == 1) ++first;
    if (first + 1 >= leaf_) return {};
    return {length_.begin() + static_cast<std::ptrdiff_t>(first),
            length_.begin() + static_cast<std::ptrdiff_t>(leaf_)};
  }

 private:
  void count() {
    if (depth_ <= kMaxDimensions) ++count_[depth_ - 1];
  }

  std::array<std::size_t, kMaxDimensions> count_{};
  std::array<std::size_t, kMaxDimensions> length_{};
  std::size_t depth_ = 0;
  std::size_t leaf_ = 0;
  bool regular_ = true;
};

// Moves `at` behind a suffix that tells a number's type.
void skipSuffix(std::string_view text, std::size_t& at) {
  for (const std::string_view suffix :
       {"_f32", "_f64", "_u16", "f32", "f64", "u16", "f", "F", "h", "H", "u", "U"}) {
    if (!text.substr(at).starts_with(suffix)) continue;
    at += suffix.size();
    return;
  }
}

// One number at `at`, which moves behind it. False where there is none, or one that no table has.
bool readNumber(std::string_view text, std::size_t& at, float& value) {
  // a sign may stand apart: "- 4.5e-07"
  const bool negative = text[at] == '-';
  if (text[at] == '+' || negative) at = skipBlanks(text, at + 1);
  if (at >= text.size() || text[at] == '-') return false;
  const char* const begin = text.data() + at;
  const char* const end = text.data() + text.size();
  const char* last;
  if (text.substr(at, 2) == "0x" || text.substr(at, 2) == "0X") {
    std::uint16_t bits = 0;
    const auto result = std::from_chars(begin + 2, end, bits, 16);
    if (result.ec != std::errc() || result.ptr == begin + 2) return false;
    value = static_cast<float>(bits);
    last = result.ptr;
  } else {
    const auto result = std::from_chars(begin, end, value);
    last = result.ptr;
    if (last == begin) return false;
    // too small for a float32 is 0 or subnormal; too large is infinite, and no table's number
    if (result.ec == std::errc::result_out_of_range)
      value = std::strtof(std::string(begin, last).c_str(), nullptr);
    if (!std::isfinite(value)) return false;
  }
  if (negative) value = -value;
  std::size_t behind = at + static_cast<std::size_t>(last - begin);
  skipSuffix(text, behind);
  if (behind < text.size() && isWord(text[behind])) return false;
  at = behind;
  return true;
}

// Numbers between the bracket at `at` and the one that closes it. Moves `at` behind what was read.
bool readNumbers(std::string_view text, std::size_t& at, TextArray& array) {
  Nesting nesting;
  for (;;) {
    at = skipBlanks(text, at);
    if (at >= text.size()) return false;
    const char c = text[at];
    if (isOneOf(c, "[{(")) {
      nesting.open();
      ++at;
    } else if (isOneOf(c, "]})")) {
      ++at;
      if (!nesting.close()) continue;
      if (array.shape.empty()) array.shape = nesting.shape();
      return true;
    } else if (c == ',') {
      ++at;
    } else {
      float value = 0.0f;
      if (!readNumber(text, at, value)) return false;
      nesting.number();
      array.values.push_back(value);
    }
  }
}

std::string printable(std::string_view text) {
  std::string out(text.substr(0, kFoundLength));
  std::replace_if(
      out.begin(), out.end(), [](unsigned char c) { return c < 0x20 || c > 0x7E; }, ' ');
  return out;
}

}  // namespace

std::vector<TextArray> arraysOfText(std::string_view text, std::vector<DamagedArray>* damaged) {
  std::vector<TextArray> arrays;
  for (std::size_t at = 0; (at = text.find_first_of("=:", at)) != std::string_view::npos;) {
    const std::size_t separator = at++;
    // what is skipped here is not searched again: a comment without end would be, once for each '=' in it
    at = skipBlanks(text, at);
    const bool isMember = text[separator] == ':';
    if (isMember && (at >= text.size() || text[at] != '[')) continue;
    const std::size_t open = isMember ? at : openingOf(text, at);
    if (open == std::string_view::npos) continue;
    TextArray array;
    if (!readName(text, separator, array)) continue;
    at = open;
    const bool whole = readNumbers(text, at, array);
    if (array.values.empty()) continue;
    if (whole) {
      arrays.push_back(std::move(array));
    } else if (damaged != nullptr) {
      damaged->push_back({std::move(array.name), array.values.size(), printable(text.substr(at))});
    }
  }
  return arrays;
}

}  // namespace ltcfit
