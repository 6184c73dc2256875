#include "render/reference.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/diagnostics.h"
#include "base/parallel_for.h"
#include "render/direct_light.h"

namespace ltcfit {

using Eigen::Vector3d;

namespace {

// Pixels are sampled in tasks of this many.
constexpr std::size_t kChunk = 32;

struct Pixel {
  std::size_t index;  // in the film
  SurfacePoint point;
  std::size_t samples = 0;
  std::vector<Vector3d> sums;  // of each randomisation
  double variance = 0.0;       // of the mean
};

// Variance of the mean over the randomisations, each of them an estimate of its own; mean over the channels.
double varianceOf(const Pixel& pixel, const Vector3d& mean) {
  const double replicates = static_cast<double>(pixel.sums.size());
  const double scale = replicates / static_cast<double>(pixel.samples);
  double sum = 0.0;
  for (const Vector3d& s : pixel.sums) sum += (scale * s - mean).squaredNorm();
  return sum / (3.0 * replicates * (replicates - 1.0));
}

// A pixel whose few samples all missed a small feature claims no error. Its neighbours see the same feature,
// and some of them hit it: the larger of its own variance and the mean of those around it, brought to its
// number of samples as if each took its share of one sum of random ones.
std::vector<double> guardedVariances(const std::vector<Pixel>& pixels, const Film& film) {
  std::vector<const Pixel*> at(film.kinds.size(), nullptr);
  for (const Pixel& pixel : pixels) at[pixel.index] = &pixel;
  std::vector<double> out;
  for (const Pixel& pixel : pixels) {
    const std::size_t column = pixel.index % film.width;
    const std::size_t row = pixel.index / film.width;
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t y = row - std::min<std::size_t>(row, 1); y < std::min(row + 2, film.height); ++y) {
      for (std::size_t x = column - std::min<std::size_t>(column, 1); x < std::min(column + 2, film.width);
           ++x) {
        const Pixel* const other = at[y * film.width + x];
        if (other == nullptr || other->point.surface != pixel.point.surface) continue;
        sum += other->variance * static_cast<double>(other->samples) / static_cast<double>(pixel.samples);
        count += 1.0;
      }
    }
    out.push_back(std::max(pixel.variance, sum / count));
  }
  return out;
}

// Level above which errors have to come down for the sum of variances to reach `target`, when all above it
// are brought down to it. 0 if none would do.
double levelFor(std::vector<double> variances, double target) {
  std::sort(variances.begin(), variances.end());
  double below = 0.0;
  for (std::size_t i = 0; i < variances.size(); ++i) {
    const double level = (target - below) / static_cast<double>(variances.size() - i);
    if (level <= variances[i]) return std::max(level, 0.0);
    below += variances[i];
  }
  return variances.empty() ? 0.0 : variances.back();
}

}  // namespace

bool ReferenceOptions::isValid(std::string* error) const {
  if (!std::has_single_bit(replicates) || replicates < 4 || replicates > 32) {
    *error = fmt::format("replicates = {}: need 4, 8, 16 or 32", replicates);
  } else if (!std::has_single_bit(minSamples) || minSamples < 2 * replicates) {
    *error = fmt::format("minSamples = {}: need a power of two, at least {}", minSamples, 2 * replicates);
  } else if (!std::has_single_bit(maxSamples) || maxSamples < minSamples || maxSamples > (1u << 30)) {
    *error = fmt::format("maxSamples = {}: need a power of two from {} to 2^30", maxSamples, minSamples);
  } else if (!(targetRmse >= 0.0)) {
    *error = fmt::format("targetRmse = {}: need 0 or more", targetRmse);
  } else {
    return true;
  }
  return false;
}

ReferenceFilm renderReference(const Scene& scene, const ReferenceOptions& options,
                              const ReferenceProgress& progress) {
  std::string error;
  if (!options.isValid(&error)) {
    abortWith("renderReference: %s", error.c_str());
  }
  ReferenceFilm out;
  out.film = Film(scene.camera.width, scene.camera.height);
  out.standardError.assign(out.film.radiance.size(), 0.0);
  std::vector<LightPlane> planes;
  for (const PolygonLight& light : scene.lights) planes.emplace_back(light);

  std::vector<Pixel> pixels;
  for (std::size_t i = 0; i < out.film.radiance.size(); ++i) {
    const PixelView view = viewPixel(scene, i % out.film.width, i / out.film.width);
    out.film.kinds[i] = view.kind;
    if (view.kind == PixelKind::kLight) out.film.radiance[i] = view.radiance;
    if (view.kind == PixelKind::kSurface)
      pixels.push_back({i, view.point, 0, std::vector<Vector3d>(options.replicates, Vector3d::Zero()), 0.0});
  }
  out.surfacePixels = pixels.size();
  out.reachedTarget = pixels.empty();

  const double target = options.targetRmse * options.targetRmse * static_cast<double>(pixels.size());
  std::size_t done = 0;
  std::size_t total = pixels.size() * options.minSamples;
  std::vector<Pixel*> round;
  for (Pixel& pixel : pixels) round.push_back(&pixel);
  const DirectLight unlit(scene, planes, options.sampling);
  std::vector<DirectLight> lights(static_cast<std::size_t>(threadCount(options.threads)), unlit);
  while (!round.empty()) {
    const std::size_t chunks = (round.size() + kChunk - 1) / kChunk;
    parallelFor(chunks, {.threads = options.threads}, [&](std::size_t chunk, std::size_t slot) {
      DirectLight& light = lights[slot];
      const std::size_t begin = chunk * kChunk;
      std::size_t taken = 0;
      for (std::size_t k = begin; k < std::min(begin + kChunk, round.size()); ++k) {
        Pixel& pixel = *round[k];
        const std::size_t upTo = std::max(options.minSamples, 2 * pixel.samples);
        const auto first = static_cast<std::uint32_t>(pixel.samples / options.replicates);
        const auto count = static_cast<std::uint32_t>(upTo / options.replicates) - first;
        light.setPoint(pixel.point);
        if (light.isLit()) {
          for (std::size_t r = 0; r < options.replicates; ++r)
            pixel.sums[r] += light.sum(mixSeed(mixSeed(options.seed, pixel.index), r), first, count);
        }
        taken += upTo - pixel.samples;
        pixel.samples = upTo;
        Vector3d mean = Vector3d::Zero();
        for (const Vector3d& sum : pixel.sums) mean += sum / static_cast<double>(upTo);
        pixel.variance = varianceOf(pixel, mean);
        out.film.radiance[pixel.index] = mean;
        out.standardError[pixel.index] = std::sqrt(pixel.variance);
      }
      return [&, taken] {
        if (progress) progress(done += taken, total);
      };
    });
    round.clear();
    const std::vector<double> variances = guardedVariances(pixels, out.film);
    out.reachedTarget = std::accumulate(variances.begin(), variances.end(), 0.0) <= target;
    if (out.reachedTarget) break;
    const double level = levelFor(variances, target);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (variances[i] <= level || pixels[i].samples >= options.maxSamples) continue;
      total += pixels[i].samples;
      round.push_back(&pixels[i]);
    }
  }
  double variance = 0.0;
  for (const Pixel& pixel : pixels) {
    variance += pixel.variance;
    out.meanSamples += static_cast<double>(pixel.samples);
  }
  if (!pixels.empty()) {
    out.ownRmse = std::sqrt(variance / static_cast<double>(pixels.size()));
    out.meanSamples /= static_cast<double>(pixels.size());
  }
  return out;
}

}  // namespace ltcfit
