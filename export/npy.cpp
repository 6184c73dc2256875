#include "export/npy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "export/atomic_file.h"
#include "export/little_endian.h"

namespace ltcfit {
namespace {

constexpr std::string_view kNpyMagic = "\x93NUMPY";
// Numbers in one array: well above a 64^4 table of 9.
constexpr std::size_t kMaxNumbers = std::size_t{1} << 29;

// The product of a shape, or 0 where it is absurd.
std::size_t numberCount(const std::vector<std::size_t>& shape) {
  std::size_t n = 1;
  for (std::size_t s : shape) {
    if (s == 0 || s > kMaxNumbers || n > kMaxNumbers / s) return 0;
    n *= s;
  }
  return n;
}

// The tuple behind 'shape': of the header's Python dict.
std::vector<std::size_t> parseShape(std::string_view header, const std::string& name) {
  const auto bad = [&]() -> std::size_t { throw InputError(name + ": .npy header: cannot read 'shape'"); };
  std::size_t at = header.find("'shape':");
  at = at == std::string_view::npos ? bad() : header.find('(', at);
  if (at == std::string_view::npos) bad();
  std::vector<std::size_t> shape;
  std::size_t value = 0;
  bool digits = false;
  for (++at; at < header.size(); ++at) {
    const char c = header[at];
    if (c >= '0' && c <= '9') {
      value = std::min(value * 10 + static_cast<std::size_t>(c - '0'), kMaxNumbers + 1);
      digits = true;
    } else if (c == ',' || c == ')') {
      if (digits) shape.push_back(value);
      value = 0;
      digits = false;
      if (c == ')') return shape;
    } else if (c != ' ') {
      bad();
    }
  }
  bad();
  return shape;
}

}  // namespace

std::string arrayToNpy(const FloatArray& array, Precision precision) {
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}",
                                   precision == Precision::kHalf ? "<f2" : "<f4",
                                   fmt::join(array.shape, ", "), array.shape.size() == 1 ? "," : "");
  // the data start at a multiple of 64
  header.append(63 - (kNpyMagic.size() + 4 + header.size()) % 64, ' ');
  header += '\n';
  std::string out(kNpyMagic);
  out += '\x01';
  out += '\0';
  append(out, static_cast<std::uint16_t>(header.size()));
  out += header;
  appendValues(out, array.values, precision);
  return out;
}

bool isNpy(std::string_view bytes) {
  return bytes.starts_with(kNpyMagic);
}

FloatArray parseNpy(std::string_view bytes, const std::string& name) {
  if (!isNpy(bytes) || bytes.size() < 12)
    throw InputError(name + ": not a .npy file, or cut off in its header");
  const int major = static_cast<unsigned char>(bytes[6]);
  if (major < 1 || major > 3) throw InputError(fmt::format("{}: .npy version {} is not known", name, major));
  const std::size_t start = major == 1 ? 10 : 12;
  const std::size_t length = major == 1 ? readAt<std::uint16_t>(bytes, 8) : readAt<std::uint32_t>(bytes, 8);
  if (length > bytes.size() - start) throw InputError(name + ": cut off in its .npy header");
  const std::string_view header = bytes.substr(start, length);
  const bool half = header.find("'descr': '<f2'") != std::string_view::npos;
  if (!half && header.find("'descr': '<f4'") == std::string_view::npos)
    throw InputError(name + ": .npy header: need little-endian float32 or float16 ('<f4', '<f2')");
  if (header.find("'fortran_order': False") == std::string_view::npos) {
    throw InputError(name + ": .npy header: need C order");
  }
  FloatArray array;
  array.shape = parseShape(header, name);
  const std::size_t count = numberCount(array.shape);
  const std::size_t present = bytes.size() - start - length;
  if (count == 0 || count * (half ? 2 : 4) != present) {
    throw InputError(fmt::format("{}: shape {} does not fit the {} bytes of data", name,
                                 fmt::format("({})", fmt::join(array.shape, ", ")), present));
  }
  array.values = readValues(bytes.substr(start + length), half ? Precision::kHalf : Precision::kFloat);
  return array;
}

}  // namespace ltcfit
