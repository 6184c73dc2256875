#include "export/little_endian.h"

#include <fmt/format.h>

#include <Eigen/Core>

namespace ltcfit {

std::uint16_t halfBits(float value) {
  return Eigen::numext::bit_cast<std::uint16_t>(Eigen::half(value));
}

float halfValue(std::uint16_t bits) {
  return static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(bits));
}

void appendValues(std::string& bytes, const std::vector<float>& values, Precision precision) {
  if (precision == Precision::kFloat) {
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    return;
  }
  bytes.reserve(bytes.size() + values.size() * 2);
  for (float v : values) append(bytes, halfBits(v));
}

std::vector<float> readValues(std::string_view bytes, Precision precision) {
  const std::size_t size = precision == Precision::kHalf ? 2 : 4;
  std::vector<float> values(bytes.size() / size);
  if (precision == Precision::kFloat) {
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * size);
    return values;
  }
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = halfValue(readAt<std::uint16_t>(bytes, 2 * i));
  return values;
}

std::string checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return fmt::format("{:016x}", hash);
}

}  // namespace ltcfit
