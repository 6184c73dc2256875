#include "render/picture_error.h"

#include <algorithm>
#include <cmath>

#include "base/diagnostics.h"

namespace ltcfit {
namespace {

constexpr double kLargestPsnr = 150.0;  // float32 radiance knows nothing beyond
constexpr double kRelativeFloor = 0.01;

}  // namespace

double brightest(const Film& film) {
  double out = 0.0;
  for (std::size_t i = 0; i < film.radiance.size(); ++i)
    if (film.kinds[i] == PixelKind::kSurface && film.radiance[i].allFinite())
      out = std::max(out, film.radiance[i].maxCoeff());
  return out;
}

PictureError pictureError(const Film& film, const Film& reference, double peak) {
  if (film.width != reference.width || film.height != reference.height) {
    abortWith("pictureError: %zu x %zu against %zu x %zu", film.width, film.height, reference.width,
              reference.height);
  }
  PictureError e;
  double squares = 0.0;
  double relative = 0.0;
  for (std::size_t i = 0; i < film.radiance.size(); ++i) {
    const Eigen::Vector3d& a = film.radiance[i];
    const Eigen::Vector3d& b = reference.radiance[i];
    if (!a.allFinite()) ++e.nonFinite;
    if (film.kinds[i] != reference.kinds[i]) ++e.kindsDiffer;
    if (film.kinds[i] != PixelKind::kSurface || reference.kinds[i] != PixelKind::kSurface) continue;
    if (!a.allFinite() || !b.allFinite()) continue;
    ++e.pixels;
    const Eigen::Array3d difference = (a - b).array();
    squares += difference.square().mean();
    relative += (difference.square() / (b.array().square() + kRelativeFloor)).mean();
    e.largest = std::max(e.largest, difference.abs().maxCoeff());
  }
  e.psnr = kLargestPsnr;
  if (e.pixels == 0) return e;
  const double mse = squares / static_cast<double>(e.pixels);
  e.rmse = std::sqrt(mse);
  e.relativeMse = relative / static_cast<double>(e.pixels);
  if (mse > 0.0) e.psnr = std::min(kLargestPsnr, 20.0 * std::log10(peak) - 10.0 * std::log10(mse));
  return e;
}

}  // namespace ltcfit
