#include "scene/gltf_uri.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cctype>
#include <vector>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const int lower = std::tolower(static_cast<unsigned char>(c));
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

// Unlike tinygltf's, it leaves '+' alone, which stands for itself in a path.
std::string percentDecoded(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hexDigit(uri[i + 1]) : -1;
    const int low = high < 0 ? -1 : hexDigit(uri[i + 2]);
    if (low < 0) {
      out += uri[i];
    } else {
      out += static_cast<char>(high * 16 + low);
      i += 2;
    }
  }
  return out;
}

bool hasScheme(const std::string& uri) {
  const std::size_t end = uri.find_first_of(":/");
  return end != std::string::npos && uri[end] == ':';
}

}  // namespace

bool isDataUri(const std::string& uri) {
  return uri.starts_with("data:");
}

std::string dataOfUri(const std::string& uri, const std::string& name) {
  const std::size_t comma = uri.find(',');
  // tinygltf decodes the media types it knows; base64 is the same for all
  constexpr const char* kAny = "data:application/octet-stream;base64,";
  if (comma != std::string::npos && uri.substr(0, comma).ends_with(";base64")) {
    std::vector<unsigned char> bytes;
    std::string mediaType;
    if (tinygltf::DecodeDataURI(&bytes, mediaType, kAny + uri.substr(comma + 1), 0, false))
      return {bytes.begin(), bytes.end()};
  }
  throw InputError(fmt::format("{} has a data URI that is not base64", name));
}

std::string readRelative(const std::filesystem::path& folder, const std::string& uri) {
  if (hasScheme(uri)) throw InputError(fmt::format("'{}' is not a file beside it", shortened(uri)));
  const std::filesystem::path path(percentDecoded(uri));
  if (path.is_absolute()) throw InputError(fmt::format("'{}' is an absolute path", shortened(uri)));
  constexpr std::uint64_t kLimit = std::uint64_t{1} << 30;
  const std::filesystem::path full = folder / path;
  std::error_code ignored;
  if (full.native().find('\0') != std::string::npos || !std::filesystem::is_regular_file(full, ignored))
    throw InputError(fmt::format("'{}', which it names, is not a file", shortened(uri)));
  return readFile(full.string(), kLimit);
}

std::string shortened(const std::string& text) {
  constexpr std::size_t kMost = 100;
  if (text.size() <= kMost) return text;
  std::size_t end = kMost;
  // not within a UTF-8 character
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return text.substr(0, end) + "...";
}

}  // namespace ltcfit
