// Quasi-random points in the unit square, randomised so that independent estimates can be made of them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>

#include "ggx/random.h"

namespace ltcfit {

/// The first two dimensions of Sobol's sequence, a (0,2)-sequence in base 2: any 2^k points from a multiple
/// of 2^k on lie one each in the 2^k boxes of every shape 2^-i by 2^-(k-i). Owen's nested scrambling, which
/// keeps that, by the hash of Laine and Karras 2011 with the constants of Burley 2020 ("Practical Hash-based
/// Owen Scrambling"): each point by itself is uniform, and different seeds give independent estimates. Points
/// of a block of 2^k come in Gray-code order. 32 bits each.
class SobolPoints {
 public:
  /// Starts at point `first`: blocks of one seed continue each other.
  explicit SobolPoints(std::uint64_t seed, std::uint32_t first = 0)
      : seedX_(static_cast<std::uint32_t>(mixSeed(seed, 0))),
        seedY_(static_cast<std::uint32_t>(mixSeed(seed, 0) >> 32)),
        index_(first),
        x_(first ^ (first >> 1)) {
    for (std::uint32_t rest = x_; rest != 0; rest &= rest - 1) y_ ^= kColumns[lowestBit(rest)];
  }

  /// Both coordinates in (0, 1): centres of cells of width 2^-32.
  Eigen::Vector2d next() {
    const Eigen::Vector2d point(toUnit(scramble(x_, seedX_)), toUnit(scramble(y_, seedY_)));
    ++index_;
    x_ ^= index_ & (~index_ + 1u);
    y_ ^= kColumns[lowestBit(index_) & 31u];
    return point;
  }

 private:
  // All digits are kept in reverse, the most significant one in bit 0: the order in which carries of the hash
  // run. The first dimension's matrix is then the identity, and this is the second's.
  static constexpr std::array<std::uint32_t, 32> kColumns = [] {
    std::array<std::uint32_t, 32> columns{1u};
    for (std::size_t i = 1; i < 32; ++i) columns[i] = columns[i - 1] ^ (columns[i - 1] << 1);
    return columns;
  }();

  static std::size_t lowestBit(std::uint32_t x) { return static_cast<std::size_t>(std::countr_zero(x)); }

  static std::uint32_t scramble(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
  }

  static double toUnit(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    return (static_cast<double>(__builtin_bswap32(x)) + 0.5) * 0x1p-32;
  }

  std::uint32_t seedX_;
  std::uint32_t seedY_;
  std::uint32_t index_;
  std::uint32_t x_;
  std::uint32_t y_ = 0;
};

}  // namespace ltcfit
