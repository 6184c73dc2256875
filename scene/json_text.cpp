#include "scene/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// The letters around a byte, counted from 1.
std::string_view wordAt(std::string_view text, std::size_t byte) {
  std::size_t end = std::min(byte, text.size());
  std::size_t start = end;
  while (start > 0 && isLetter(text[start - 1])) --start;
  while (end < text.size() && isLetter(text[end])) ++end;
  return text.substr(start, end - start);
}

bool isNoNumber(std::string_view word) {
  constexpr std::array<std::string_view, 6> kWords{"NaN", "nan", "Infinity", "infinity", "Inf", "inf"};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

}  // namespace

nlohmann::json parseJsonText(std::string_view text) {
  // the parser takes a zero for the end
  if (text.find('\0') != std::string_view::npos) throw InputError("a zero byte within the JSON");
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const std::string_view word = wordAt(text, error.byte);
    if (isNoNumber(word))
      throw InputError(fmt::format("{} at byte {}: JSON knows neither NaN nor Infinity", word, error.byte));
    throw InputError(
        fmt::format("no valid JSON at byte {} of {} (cut off or damaged?)", error.byte, text.size()));
  } catch (const nlohmann::json::out_of_range&) {
    throw InputError("a number is out of range, beyond 1.8e308");
  }
}

}  // namespace ltcfit
