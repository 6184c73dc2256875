// Numbers in files: little-endian, whatever the alignment.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "export/image.h"

namespace ltcfit {

static_assert(std::endian::native == std::endian::little, "readers and writers copy little-endian numbers");

template <std::integral T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// The number at `offset`; the caller has checked that it lies within `bytes`.
template <std::integral T>
T readAt(std::string_view bytes, std::size_t offset) {
  T value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// IEEE half of a float, nearest, ties to even; and back, exactly.
std::uint16_t halfBits(float value);
float halfValue(std::uint16_t bits);

/// `values` one after the other in the precision told.
void appendValues(std::string& bytes, const std::vector<float>& values, Precision precision);

/// FNV-1a, 64 bits, as 16 hexadecimal digits: tells files apart that got mixed up, no more.
std::string checksum(std::string_view bytes);

/// Reads as many numbers as `bytes` holds.
std::vector<float> readValues(std::string_view bytes, Precision precision);

}  // namespace ltcfit
