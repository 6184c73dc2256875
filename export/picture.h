// Pictures that lights show, as linear radiance.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ltcfit {

/// Linear RGB, row by row from the top.
struct LinearPicture {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Eigen::Vector3d> texels;
};

/// Largest width and height of a picture.
inline constexpr std::size_t kMaxPictureSide = 8192;

/// InputError with `name` where a side is 0 or more than that.
void checkPictureSize(std::size_t width, std::size_t height, const std::string& name);

/// The linear value of an sRGB one, both 0..1 (IEC 61966-2-1).
double linearFromSrgb(double value);

bool isPng(std::string_view bytes);

/// Grey, RGB and palette, with alpha or without, 1 to 16 bits, interlaced or not. Values are sRGB unless the
/// file has another gamma; alpha, if any, is multiplied in. Values of up to 8 bits are decoded exactly, those
/// of 16 bits to 1/65535 of the linear range. InputError with `name` for what is damaged, larger than
/// kMaxPictureSide, or claims more pixels than its length can hold, before anything of that size is
/// allocated.
LinearPicture parsePng(std::string_view bytes, const std::string& name);

}  // namespace ltcfit
