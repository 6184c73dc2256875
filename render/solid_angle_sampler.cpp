#include "render/solid_angle_sampler.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ggx/sin_cos.h"

namespace ltcfit {

using Eigen::Vector3d;

// With unit a, b, c the solid angle s has tan(s / 2) = det(a, b, c) / (1 + a.b + b.c + c.a) (van Oosterom and
// Strackee 1983).
SphericalTriangle::SphericalTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  if (!(la > 0.0 && lb > 0.0 && lc > 0.0)) return;
  a_ = a / la;
  b_ = b / lb;
  c_ = c / lc;
  // from the edges, since those are exact where the triangle is tiny
  volume_ = std::abs((a / la).dot(((b - a) / lb).cross((c - a) / lc)));
  toB_ = 1.0 + a_.dot(b_);
  toC_ = a_.dot(c_) + b_.dot(c_);
  solidAngle_ = 2.0 * std::atan2(volume_, toB_ + toC_);
  if (!(volume_ > 0.0) || !std::isfinite(solidAngle_)) solidAngle_ = 0.0;
}

// The triangle (a, b, p) shall have the solid angle s = u.x solidAngle, with p on the arc from a to c. Write
// p as the mirror image of a in a vector h, p = 2 (a.h) / (h.h) h - a: then the quotient above becomes
//   tan(s / 2) = det(a, b, h) / ((a + b).h),
// which is linear in h = f a + g c:  g volume cos(s/2) = (f (1 + a.b) + g (a.c + b.c)) sin(s/2).
// Along the arc from b to p, 1 - cosine from b is uniform.
Vector3d SphericalTriangle::sample(const Eigen::Vector2d& u) const {
  double sine;
  double cosine;
  sinCos(0.5 * u.x() * solidAngle_, sine, cosine);
  const Vector3d h = (volume_ * cosine - toC_ * sine) * a_ + (toB_ * sine) * c_;
  const double hh = h.squaredNorm();
  if (!(hh > 0.0)) return a_;
  const Vector3d p = (2.0 * a_.dot(h) / hh) * h - a_;
  const double rest = 0.5 * (p + b_).squaredNorm();  // 1 + b.p
  if (!(rest > 0.0)) return p;
  const double whole = std::min(0.5 * (p - b_).squaredNorm(), 2.0);  // 1 - b.p, but for rounding
  const double part = u.y() * whole;
  const double along = std::sqrt(u.y() * (2.0 - part) / rest);
  return along * (p + b_) + (1.0 - part - along * rest) * b_;
}

void SolidAngleSampler::add(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const SphericalTriangle triangle(a, b, c);
  if (!(triangle.solidAngle() > 0.0)) return;
  triangles_.push_back(triangle);
  total_ += triangle.solidAngle();
  ends_.push_back(total_);
}

void SolidAngleSampler::set(std::span<const Vector3d> vertices,
                            std::span<const std::array<std::size_t, 3>> triangles) {
  triangles_.clear();
  ends_.clear();
  total_ = 0.0;
  for (const std::array<std::size_t, 3>& t : triangles) {
    std::array<Vector3d, 4> kept;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d& a = vertices[t[i]];
      const Vector3d& b = vertices[t[(i + 1) % 3]];
      if (a.z() > 0.0) kept[count++] = a;
      if ((a.z() > 0.0) != (b.z() > 0.0)) {
        kept[count] = (a * b.z() - b * a.z()) / (b.z() - a.z());
        kept[count++].z() = 0.0;
      }
    }
    for (std::size_t i = 2; i < count; ++i) add(kept[0], kept[i - 1], kept[i]);
  }
}

Vector3d SolidAngleSampler::sample(const Eigen::Vector2d& u) const {
  const double place = u.x() * total_;
  std::size_t i = 0;
  while (i + 1 < ends_.size() && place >= ends_[i]) ++i;
  const double begin = i == 0 ? 0.0 : ends_[i - 1];
  const double share = (place - begin) / triangles_[i].solidAngle();
  return triangles_[i].sample({std::clamp(share, 0.0, 1.0), u.y()});
}

}  // namespace ltcfit
