#include "export/published_table.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

static_assert(std::endian::native == std::endian::little, "the readers copy little-endian numbers");

constexpr std::string_view kNpyMagic = "\x93NUMPY";
constexpr std::string_view kDdsMagic = "DDS ";
constexpr double kHalfPi = 0.5 * std::numbers::pi;
// What the authors' fitting codes clamp to.
constexpr double kFloor2017 = 1e-5;
constexpr double kTheta2017 = 1.57;
constexpr double kFloor2022 = 1e-4;
constexpr double kTheta2022 = 0.9999 * kHalfPi;
// Numbers in one array: well above a 64^4 table of 9.
constexpr std::size_t kMaxNumbers = std::size_t{1} << 29;

std::uint32_t word(std::string_view bytes, std::size_t offset) {
  std::uint32_t v = 0;
  std::memcpy(&v, bytes.data() + offset, sizeof v);
  return v;
}

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

std::string shapeText(const std::vector<std::size_t>& shape) {
  return fmt::format("({})", fmt::join(shape, ", "));
}

Axis withLastValue(Axis axis, double value) {
  axis.values.back() = value;
  return axis;
}

}  // namespace

bool isNpy(std::string_view bytes) {
  return bytes.starts_with(kNpyMagic);
}
bool isDds(std::string_view bytes) {
  return bytes.starts_with(kDdsMagic);
}

FloatArray parseNpy(std::string_view bytes, const std::string& name) {
  if (!isNpy(bytes) || bytes.size() < 12)
    throw InputError(name + ": not a .npy file, or cut off in its header");
  const int major = static_cast<unsigned char>(bytes[6]);
  if (major < 1 || major > 3) throw InputError(fmt::format("{}: .npy version {} is not known", name, major));
  const std::size_t start = major == 1 ? 10 : 12;
  const std::size_t length = major == 1 ? word(bytes, 8) & 0xFFFFu : word(bytes, 8);
  if (length > bytes.size() - start) throw InputError(name + ": cut off in its .npy header");
  const std::string_view header = bytes.substr(start, length);
  if (header.find("'descr': '<f4'") == std::string_view::npos) {
    throw InputError(name + ": .npy header: need little-endian float32 ('<f4')");
  }
  if (header.find("'fortran_order': False") == std::string_view::npos) {
    throw InputError(name + ": .npy header: need C order");
  }
  FloatArray array;
  array.shape = parseShape(header, name);
  const std::size_t count = numberCount(array.shape);
  const std::size_t present = bytes.size() - start - length;
  if (count == 0 || count * sizeof(float) != present) {
    throw InputError(
        fmt::format("{}: shape {} does not fit the {} bytes of data", name, shapeText(array.shape), present));
  }
  array.values.resize(count);
  std::memcpy(array.values.data(), bytes.data() + start + length, present);
  return array;
}

FloatArray parseDds(std::string_view bytes, const std::string& name) {
  constexpr std::size_t kHeader = 128;
  constexpr std::uint32_t kRgbaHalf = 113;
  if (!isDds(bytes) || bytes.size() < kHeader || word(bytes, 4) != 124) {
    throw InputError(name + ": not a DDS file, or cut off in its header");
  }
  const std::size_t height = word(bytes, 12);
  const std::size_t width = word(bytes, 16);
  if (word(bytes, 84) != kRgbaHalf) {
    throw InputError(fmt::format("{}: DDS FourCC {} is not known (113, RGBA half)", name, word(bytes, 84)));
  }
  FloatArray array;
  array.shape = {height, width, 4};
  const std::size_t count = numberCount(array.shape);
  const std::size_t present = bytes.size() - kHeader;
  if (count == 0 || count * sizeof(std::uint16_t) != present) {
    throw InputError(
        fmt::format("{}: {} x {} texels do not fit the {} bytes of data", name, width, height, present));
  }
  array.values.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint16_t bits = 0;
    std::memcpy(&bits, bytes.data() + kHeader + i * sizeof bits, sizeof bits);
    array.values[i] = static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(bits));
  }
  return array;
}

Table tableFrom2017(const FloatArray& first, const FloatArray* second, const std::string& name) {
  if (first.shape.size() != 3 || first.shape[2] != 4 || first.shape[0] < 2 || first.shape[1] < 2) {
    throw InputError(
        name + ": shape " + shapeText(first.shape) +
        " is neither (y, x, 4), the 2017 table, nor (alpha, lambda, theta, phi, 3, 3), the 2022 one");
  }
  if (second != nullptr && second->shape != first.shape) {
    throw InputError(name + ": the second texture's shape " + shapeText(second->shape) + " is not " +
                     shapeText(first.shape));
  }
  const std::size_t texels = first.shape[0] * first.shape[1];
  bool thirdIsZero = true;
  for (std::size_t i = 0; i < texels; ++i) thirdIsZero = thirdIsZero && first.values[i * 4 + 2] == 0.0f;
  if (thirdIsZero)
    throw InputError(name + ": this is the second texture (norm, Fresnel); give the first one");

  TableInfo info;
  info.stores = MatrixStorage::kMinv;
  info.normalization = MatrixNormalization::kMiddleElement;
  info.channels = {"m00", "m20", "m02", "m22", "m11"};
  if (second != nullptr) info.channels.insert(info.channels.end(), {"norm", "fresnel"});
  info.alphaFloor = kFloor2017;
  info.provenance.tool = "published 2017 table";
  info.provenance.options = {{"family", std::string("3")}};  // what its authors' code fits
  std::vector<float> data;
  data.reserve(texels * info.channels.size());
  for (std::size_t i = 0; i < texels; ++i) {
    for (std::size_t c = 0; c < 4; ++c) data.push_back(first.values[i * 4 + c]);
    data.push_back(1.0f);
    if (second != nullptr) data.insert(data.end(), {second->values[i * 4], second->values[i * 4 + 1]});
  }
  try {
    info.axes.push_back(withLastValue(
        makeAxis("theta", "rad", AxisMap::kSqrtOneMinusCos, first.shape[0], 0.0, kHalfPi), kTheta2017));
    info.axes.push_back(makeAxis("alpha", "1", AxisMap::kSqrt, first.shape[1], 0.0, 1.0, kFloor2017));
    return Table(std::move(info), std::move(data));
  } catch (const std::invalid_argument& error) {
    throw InputError(name + ": " + error.what());
  }
}

Table tableFrom2022(const FloatArray& array, const std::string& name) {
  const auto& s = array.shape;
  if (s.size() != 6 || s[4] != 3 || s[5] != 3)
    throw InputError(name + ": shape " + shapeText(s) + " is not (.., 3, 3)");
  TableInfo info;
  info.stores = MatrixStorage::kM;
  info.normalization = MatrixNormalization::kThirdColumnUnit;
  info.channels = {"m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22"};
  info.alphaFloor = kFloor2022;
  info.provenance.tool = "published 2022 table";
  try {
    const AxisMap linear = AxisMap::kLinear;
    info.axes.push_back(makeAxis("alpha", "1", linear, s[0], 0.0, 1.0));
    info.axes.push_back(makeAxis("lambda", "1", linear, s[1], 0.0, 1.0));
    info.axes.push_back(makeAxis("theta", "rad", linear, s[2], 0.0, kHalfPi));
    // fitted at k / 7 * 0.9999 * pi/2, looked up with k / 7 * pi/2
    for (double& v : info.axes.back().values) v *= kTheta2022 / kHalfPi;
    info.axes.push_back(makeAxis("phi", "rad", linear, s[3], 0.0, kHalfPi));
    return Table(std::move(info), array.values);
  } catch (const std::invalid_argument& error) {
    throw InputError(name + ": " + error.what());
  }
}

}  // namespace ltcfit
