#include "render/lost_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ltcfit {
namespace {

// Errors whose means differ by less are called equal.
constexpr double kTie = 1.05;
// Of the picture's largest radiance: what is below shows the lobe's tails only.
constexpr double kDark = 0.02;
// Cosine of the view, some 70 degrees.
constexpr double kGrazing = 0.35;

}  // namespace

std::string explainLostScene(const Scene& scene, const Film& film, const Film& other, const Film& reference) {
  double peak = 0.0;
  for (std::size_t i = 0; i < reference.radiance.size(); ++i)
    if (reference.kinds[i] == PixelKind::kSurface) peak = std::max(peak, reference.radiance[i].maxCoeff());
  double ours = 0.0;
  double theirs = 0.0;
  double dark = 0.0;
  double grazing = 0.0;
  double tooDark = 0.0;
  double tooBright = 0.0;
  for (std::size_t i = 0; i < film.radiance.size(); ++i) {
    if (film.kinds[i] != PixelKind::kSurface || other.kinds[i] != PixelKind::kSurface ||
        reference.kinds[i] != PixelKind::kSurface)
      continue;
    const PixelView view = viewPixel(scene, i % film.width, i / film.width);
    if (view.kind != PixelKind::kSurface) continue;
    const Eigen::Vector3d a = film.radiance[i] - reference.radiance[i];
    const Eigen::Vector3d b = other.radiance[i] - reference.radiance[i];
    ours += a.squaredNorm();
    theirs += b.squaredNorm();
    const double excess = a.squaredNorm() - b.squaredNorm();
    if (reference.radiance[i].maxCoeff() < kDark * peak) {
      dark += excess;
    } else if (view.point.wo.z() < kGrazing) {
      grazing += excess;
    } else {
      (a.sum() < 0.0 ? tooDark : tooBright) += excess;
    }
  }
  const double ratio = std::sqrt(ours / theirs);
  if (!(ratio >= kTie))
    return fmt::format("hardly: the errors are within {:.0f} %", 100.0 * (ratio - 1.0) + 0.5);
  const double total = ours - theirs;
  const double largest = std::max({dark, grazing, tooDark, tooBright});
  const char* const where = largest == dark      ? "in the dark, where the light meets the lobe's tails only "
                                                   "(below 2 % of the picture's largest radiance)"
                            : largest == grazing ? "at grazing views, beyond 70 degrees"
                            : largest == tooDark ? "where the reflection is too dark"
                                                 : "where the reflection is too bright";
  return fmt::format("{:.0f} % of the excess is {}", 100.0 * std::min(1.0, largest / total), where);
}

}  // namespace ltcfit
