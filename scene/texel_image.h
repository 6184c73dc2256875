// Pictures of material parameters, as stored: what textures of scenes hold.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ltcfit {

/// Row by row from the top; values as stored, without alpha multiplied in or gamma taken off.
struct TexelImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::array<std::uint8_t, 4>> texels;  ///< RGBA

  const std::array<std::uint8_t, 4>& at(std::size_t x, std::size_t y) const { return texels[y * width + x]; }
};

inline constexpr std::size_t kMaxTexelSide = 16384;
/// Of all images of a scene together.
inline constexpr std::size_t kMaxTexels = std::size_t{1} << 28;

/// The name of a kind of image that scenes use and this program does not read (KTX2, WebP, AVIF, DDS), empty
/// for any other bytes.
std::string unreadableKind(std::string_view bytes);

/// A PNG or JPEG (8 bits, not CMYK); grey becomes three equal channels, missing alpha 255, 16 bits become
/// their upper 8. InputError with `name` for anything else, for what is damaged, has a side of more than
/// kMaxTexelSide or more than `maxTexels` texels, or claims more than its length can hold: before anything of
/// that size is allocated.
TexelImage decodeTexels(std::string_view bytes, const std::string& name, std::size_t maxTexels = kMaxTexels);

/// Stands for an image that could not be read: 64 x 64 texels, each channel uniform in 0..255 and independent
/// of the others (Halton points).
TexelImage uniformTexels();

/// The linear value of an sRGB one.
double linearFromSrgb8(std::uint8_t value);

/// Of linear RGB (BT.709).
double luminance(const std::array<double, 3>& rgb);

}  // namespace ltcfit
