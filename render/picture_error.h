// How far one rendered picture is from another.
#pragma once

#include <cstddef>

#include "render/film.h"

namespace ltcfit {

/// Over the pixels that show a surface in both films and are finite in both; the mean of the three channels
/// counts. Radiance is that of lights of radiance 1, so that a single light reflects at most 1.
struct PictureError {
  std::size_t pixels = 0;     ///< that count
  std::size_t nonFinite = 0;  ///< pixels with a NaN or an infinity in the first film
  /// Pixels that show another kind of thing (background, light, surface) in the one than in the other.
  std::size_t kindsDiffer = 0;
  double rmse = 0.0;         ///< root of the mean squared difference
  double relativeMse = 0.0;  ///< mean of (a - b)^2 / (b^2 + 0.01)
  double psnr = 0.0;         ///< 10 log10(peak^2 / MSE) in dB; 150 where it is higher
  double largest = 0.0;      ///< largest difference of a channel
};

/// Radiance of the brightest surface pixel, of any channel; 0 without any.
double brightest(const Film& film);

/// Films of one size; others are a caller's bug and abort. `peak` > 0: what the PSNR is of. Without a pixel
/// that counts all errors are 0 and the PSNR 150.
PictureError pictureError(const Film& film, const Film& reference, double peak = 1.0);

}  // namespace ltcfit
