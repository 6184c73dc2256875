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
  // of the pixels where the film is farther from the reference than the other
  double excess = 0.0;
  double tooDark = 0.0;
  double grazing = 0.0;
  double dark = 0.0;
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
    const double here = a.squaredNorm() - b.squaredNorm();
    if (here <= 0.0) continue;
    excess += here;
    if (a.sum() < 0.0) tooDark += here;
    if (view.point.wo.z() < kGrazing) grazing += here;
    if (reference.radiance[i].maxCoeff() < kDark * peak) dark += here;
  }
  const double ratio = std::sqrt(ours / theirs);
  if (!(ratio >= kTie))
    return fmt::format("hardly: the errors are within {:.0f} %", std::ceil(100.0 * (ratio - 1.0)));
  const auto percent = [&](double part) { return fmt::format("{:.0f} %", 100.0 * part / excess); };
  const bool isDark = tooDark > 0.5 * excess;
  std::string out = fmt::format(
      "of what is worse {} is too {}, {} seen beyond 70 degrees, {} in pixels below 2 % of the brightest",
      percent(isDark ? tooDark : excess - tooDark), isDark ? "dark" : "bright", percent(grazing),
      percent(dark));
  if (scene.surfaces[0].material.f0 < 1.0)
    out += "; F0 is below 1, where Fresnel tilts the true lobe and no table of F = 1 follows";
  return out;
}

}  // namespace ltcfit
