#include "render/direct_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ltcfit {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// Both constants below are chosen for the CPU time of renderReference on one thread, over namedScenes(true)
// and 24 of randomScene at small sizes, by building with other values.

// Samples that are evaluated together: 16 to 256 take the same time to 2 %, 8 take 4 % more.
constexpr std::uint32_t kBatch = 64;
// Up to this many times as dense as even sampling of the light the lobe leaves a smooth integrand, which
// quasi-random points of the light integrate faster than those of the lobe, that fall on either side of the
// light's outline; the faster, the smaller the error aimed at. 1, 4, 16, 64 take 1.5, 1.5, 1.7, 1.8 s to an
// error of 3e-4 and 25, 16, 12, 11 s to 3e-5, which 0, 0, 4, 6 of the 41 scenes then do not reach.
constexpr double kNarrow = 16.0;

struct Batch {
  std::array<double, kBatch> x, y, z, eval, pdf;

  Vector3d wi(std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Vector3d& w) {
    x[i] = w.x();
    y[i] = w.y();
    z[i] = w.z();
  }
  void evaluate(const GgxLobe& lobe, std::size_t n) {
    lobe.evalBatch(std::span(x).first(n), std::span(y).first(n), std::span(z).first(n),
                   std::span(eval).first(n), std::span(pdf).first(n));
  }
};

// Balance heuristic (Veach and Guibas 1995): the share of the strategy with density `own`. The power
// heuristic needs a third fewer samples for mirrors, and hides more from the error estimate: where the lobe
// is much denser than the light's samples, light is found by too few samples of the lobe, or by none.
double share(double own, double other) {
  return own / (own + other);
}

}  // namespace

void DirectLight::setPoint(const SurfacePoint& point) {
  const Material& material = point.surface->material;
  // interpolated roughness can exceed 1 by rounding
  const GgxAlpha alpha{std::min(point.alpha.x(), 1.0), std::min(point.alpha.y(), 1.0)};
  lobe_ = GgxLobe(point.wo, alpha);
  f0_ = material.f0;
  diffuse_ = material.diffuse;
  needsLobe_ = false;
  count_ = 0;
  const double highest =
      1.0 / (2.0 * std::numbers::pi * alpha.x * alpha.y *
             (point.wo.z() +
              std::sqrt(point.wo.z() * point.wo.z() + (alpha.x * point.wo.x()) * (alpha.x * point.wo.x()) +
                        (alpha.y * point.wo.y()) * (alpha.y * point.wo.y()))));
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const LightPlane& plane = planes_[i];
    const PolygonLight& light = scene_.lights[i];
    const double height = (plane.origin - point.position).dot(plane.normal);
    if (light.twoSided ? height == 0.0 : !(height > 0.0)) continue;
    vertices_.clear();
    bool above = false;
    for (const Vector3d& v : light.vertices) {
      vertices_.push_back(point.frame * (v - point.position));
      above = above || vertices_.back().z() > 0.0;
    }
    if (!above) continue;
    if (seen_.size() == count_) seen_.emplace_back();
    SeenLight& seen = seen_[count_];
    seen.sampler.set(vertices_, plane.triangles);
    if (!(seen.sampler.solidAngle() > 0.0)) continue;
    seen.index = i;
    seen.x = point.frame * plane.x;
    seen.y = point.frame * plane.y;
    seen.normal = point.frame * plane.normal;
    seen.foot = {(point.position - plane.origin).dot(plane.x), (point.position - plane.origin).dot(plane.y)};
    seen.height = height;
    seen.alone = sampling_ == ReferenceSampling::kLight ||
                 (sampling_ == ReferenceSampling::kBoth && highest * seen.sampler.solidAngle() <= kNarrow);
    needsLobe_ = needsLobe_ || !seen.alone;
    ++count_;
  }
}

double DirectLight::fresnel(const Vector3d& wi) const {
  // wo.wm = |wo + wi| / 2
  const double m = 1.0 - 0.5 * (lobe_.wo() + wi).norm();
  const double m2 = m * m;
  return f0_ + (1.0 - f0_) * m2 * m2 * m;
}

Vector3d DirectLight::emitted(const SeenLight& seen, const Vector2d& place) const {
  const PolygonLight& light = scene_.lights[seen.index];
  if (light.texture < 0) return light.radiance;
  const std::vector<Vector2d>& outline = planes_[seen.index].outline;
  const Vector2d& right = outline[1];
  const Vector2d& down = outline[3];
  const LightTexture& texture = scene_.textures[static_cast<std::size_t>(light.texture)];
  return light.radiance.cwiseProduct(
      textureAt(texture, place.dot(right) / right.squaredNorm(), place.dot(down) / down.squaredNorm()));
}

Vector3d DirectLight::sumOverLight(const SeenLight& seen, std::uint64_t seed, std::uint32_t first,
                                   std::uint32_t count) const {
  const bool textured = scene_.lights[seen.index].texture >= 0;
  const double solidAngle = seen.sampler.solidAngle();
  const double density = 1.0 / solidAngle;
  const double lambert = diffuse_ * std::numbers::inv_pi;
  Batch batch;
  Vector3d coloured = Vector3d::Zero();
  double grey = 0.0;
  SobolPoints points(seed, first);
  for (std::uint32_t done = 0; done < count; done += kBatch) {
    const std::size_t n = std::min(kBatch, count - done);
    for (std::size_t i = 0; i < n; ++i) batch.set(i, seen.sampler.sample(points.next()));
    batch.evaluate(lobe_, n);
    for (std::size_t i = 0; i < n; ++i) {
      double value = batch.eval[i];
      if (f0_ < 1.0) value *= fresnel(batch.wi(i));
      if (!seen.alone) value *= share(density, batch.pdf[i]);
      value += lambert * batch.z[i];
      if (textured) {
        coloured += value * emitted(seen, seen.place(batch.wi(i)));
      } else {
        grey += value;
      }
    }
  }
  if (!textured) coloured = grey * scene_.lights[seen.index].radiance;
  return solidAngle * coloured;
}

Vector3d DirectLight::sumOverLobe(std::uint64_t seed, std::uint32_t first, std::uint32_t count) const {
  Batch batch;
  std::array<double, kBatch> u0, u1, weight;
  Vector3d sum = Vector3d::Zero();
  SobolPoints points(seed, first);
  for (std::uint32_t done = 0; done < count; done += kBatch) {
    const std::size_t n = std::min(kBatch, count - done);
    for (std::size_t i = 0; i < n; ++i) {
      const Vector2d u = points.next();
      u0[i] = u.x();
      u1[i] = u.y();
    }
    lobe_.sampleBatch(std::span(u0).first(n), std::span(u1).first(n), std::span(batch.x).first(n),
                      std::span(batch.y).first(n), std::span(batch.z).first(n), std::span(weight).first(n));
    batch.evaluate(lobe_, n);
    for (std::size_t k = 0; k < count_; ++k) {
      const SeenLight& seen = seen_[k];
      if (seen.alone) continue;
      const bool textured = scene_.lights[seen.index].texture >= 0;
      const double density = sampling_ == ReferenceSampling::kBoth ? 1.0 / seen.sampler.solidAngle() : 0.0;
      double grey = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        const Vector3d wi = batch.wi(i);
        if (!(weight[i] > 0.0 && wi.dot(seen.normal) * seen.height > 0.0)) continue;
        const Vector2d place = seen.place(wi);
        if (!planes_[seen.index].contains(place)) continue;
        double value = weight[i] * share(batch.pdf[i], density);
        if (f0_ < 1.0) value *= fresnel(wi);
        if (textured) {
          sum += value * emitted(seen, place);
        } else {
          grey += value;
        }
      }
      sum += grey * scene_.lights[seen.index].radiance;
    }
  }
  return sum;
}

Vector3d DirectLight::sum(std::uint64_t seed, std::uint32_t first, std::uint32_t count) const {
  Vector3d sum = Vector3d::Zero();
  if (needsLobe_) sum += sumOverLobe(mixSeed(seed, 0), first, count);
  if (sampling_ == ReferenceSampling::kLobe) return sum;
  for (std::size_t k = 0; k < count_; ++k)
    sum += sumOverLight(seen_[k], mixSeed(seed, 1 + seen_[k].index), first, count);
  return sum;
}

}  // namespace ltcfit
