#include "export/npy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
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

// A number's type: bytes, and whether the last one comes first.
struct NumberType {
  std::size_t size = 0;
  bool bigEndian = false;
};

NumberType parseType(std::string_view header, const std::string& name) {
  constexpr std::string_view kKey = "'descr': '";
  const std::size_t key = header.find(kKey);
  const std::string_view type = key == std::string_view::npos ? "" : header.substr(key + kKey.size(), 4);
  for (const std::size_t size : {std::size_t{2}, std::size_t{4}, std::size_t{8}}) {
    if (type == fmt::format("<f{}'", size)) return {size, false};
    if (type == fmt::format(">f{}'", size)) return {size, true};
  }
  throw InputError(
      fmt::format("{}: .npy header: its numbers are not float16, float32 or float64 ('<f2', '<f4', '<f8', or "
                  "'>' in front)",
                  name));
}

bool parseFortranOrder(std::string_view header, const std::string& name) {
  if (header.find("'fortran_order': False") != std::string_view::npos) return false;
  if (header.find("'fortran_order': True") != std::string_view::npos) return true;
  throw InputError(name + ": .npy header: cannot read 'fortran_order'");
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

// The indices of number `flat` of an array in C order.
std::vector<std::size_t> indicesOf(std::size_t flat, const std::vector<std::size_t>& shape) {
  std::vector<std::size_t> indices(shape.size());
  for (std::size_t d = shape.size(); d-- > 0;) {
    indices[d] = flat % shape[d];
    flat /= shape[d];
  }
  return indices;
}

float rounded(double value, std::size_t flat, const std::vector<std::size_t>& shape,
              const std::string& name) {
  const auto out = static_cast<float>(value);
  if (std::isfinite(value) && !std::isfinite(out)) {
    throw InputError(fmt::format("{}: number [{}] = {} does not fit a float32", name,
                                 fmt::join(indicesOf(flat, shape), ", "), value));
  }
  return out;
}

// The numbers in C order. Of Fortran's, where the first index is fastest, the place in the file is counted
// along with the indices.
std::vector<float> readNumbers(std::string_view bytes, NumberType type, bool fortran,
                               const std::vector<std::size_t>& shape, const std::string& name) {
  const std::size_t count = bytes.size() / type.size;
  if (type.size < 8 && !type.bigEndian && !fortran)
    return readValues(bytes, type.size == 2 ? Precision::kHalf : Precision::kFloat);
  std::vector<std::size_t> strides(shape.size(), 1);  // in the file
  for (std::size_t d = 1; d < shape.size(); ++d) strides[d] = strides[d - 1] * shape[d - 1];
  std::vector<std::size_t> indices(shape.size(), 0);
  std::vector<float> values(count);
  for (std::size_t i = 0, place = 0; i < count; ++i) {
    std::array<char, 8> number{};
    bytes.copy(number.data(), type.size, (fortran ? place : i) * type.size);
    if (type.bigEndian) std::reverse(number.begin(), number.begin() + static_cast<std::ptrdiff_t>(type.size));
    const std::string_view view(number.data(), number.size());
    if (type.size == 2) values[i] = halfValue(readAt<std::uint16_t>(view, 0));
    if (type.size == 4) values[i] = std::bit_cast<float>(readAt<std::uint32_t>(view, 0));
    if (type.size == 8)
      values[i] = rounded(std::bit_cast<double>(readAt<std::uint64_t>(view, 0)), i, shape, name);
    for (std::size_t d = shape.size(); d-- > 0;) {
      place += strides[d];
      if (++indices[d] < shape[d]) break;
      place -= strides[d] * shape[d];
      indices[d] = 0;
    }
  }
  return values;
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
  const NumberType type = parseType(header, name);
  const bool fortran = parseFortranOrder(header, name);
  FloatArray array;
  array.shape = parseShape(header, name);
  const std::size_t count = numberCount(array.shape);
  const std::size_t present = bytes.size() - start - length;
  if (count == 0 || count * type.size != present) {
    throw InputError(fmt::format("{}: shape {} does not fit the {} bytes of data", name,
                                 fmt::format("({})", fmt::join(array.shape, ", ")), present));
  }
  array.values = readNumbers(bytes.substr(start + length), type, fortran, array.shape, name);
  return array;
}

}  // namespace ltcfit
