// Letters of 5 x 7 pixels for the captions of contact sheets.
#pragma once

#include <array>
#include <cstdint>

namespace ltcfit {

inline constexpr std::size_t kLetterWidth = 5;
inline constexpr std::size_t kLetterHeight = 7;

/// Rows from the top; bit 4 is the leftmost pixel. Letters as capitals; blank for what is not known: all but
/// letters, digits and . , : - _ + % ( ) /
std::array<std::uint8_t, kLetterHeight> letterRows(char c);

}  // namespace ltcfit
