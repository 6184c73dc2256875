#include "ggx/ggx_lobe.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/diagnostics.h"
#include "ggx/sin_cos.h"

namespace ltcfit {

using Eigen::Vector3d;

namespace {

double stretchedLength(const Vector3d& w, GgxAlpha alpha) {
  const double ax = alpha.x * w.x();
  const double ay = alpha.y * w.y();
  return std::sqrt(w.z() * w.z() + ax * ax + ay * ay);
}

// D at the half vector of wo and wi, from the sum h = wo + wi without normalising it: the two powers of |h|
// cancel against those of the normalisation. 0 where the half vector points down.
double ggxDOfHalfVector(const Vector3d& h, GgxAlpha alpha) {
  if (h.z() <= 0.0) return 0.0;
  const double sx = h.x() / alpha.x;
  const double sy = h.y() / alpha.y;
  const double ratio = h.squaredNorm() / (sx * sx + sy * sy + h.z() * h.z());
  return ratio * ratio / (std::numbers::pi * alpha.x * alpha.y);
}

}  // namespace

GgxLobe::GgxLobe(const Vector3d& wo, GgxAlpha alpha)
    : Lobe(wo), alpha_(alpha), stretchedWo_(stretchedLength(wo, alpha)) {
  const bool unit = std::abs(wo.squaredNorm() - 1.0) < 1e-9;
  if (!unit || !(wo.z() >= 0.0) || !(alpha.x > 0.0) || !(alpha.y > 0.0) || alpha.x > 1.0 || alpha.y > 1.0) {
    abortWith("GgxLobe: wo = (%g, %g, %g), alpha = (%g, %g): need a unit wo with z >= 0, alpha in (0, 1]",
              wo.x(), wo.y(), wo.z(), alpha.x, alpha.y);
  }
}

double GgxLobe::eval(const Vector3d& wi) const {
  if (wi.z() <= 0.0) return 0.0;
  const double d = ggxDOfHalfVector(wo() + wi, alpha_);
  return d * wi.z() / (2.0 * (stretchedWo_ * wi.z() + stretchedLength(wi, alpha_) * wo().z()));
}

double GgxLobe::pdf(const Vector3d& wi) const {
  return ggxDOfHalfVector(wo() + wi, alpha_) / (2.0 * (wo().z() + stretchedWo_));
}

double GgxLobe::acceptance(const Vector3d& wi) const {
  if (wi.z() <= 0.0) return 0.0;
  const double visible = (wo().z() + stretchedWo_) * wi.z();
  return visible / (stretchedWo_ * wi.z() + stretchedLength(wi, alpha_) * wo().z());
}

LobeSample GgxLobe::sample(const Eigen::Vector2d& u) const {
  const Vector3d wm = sampleGgxVisibleNormal(wo(), alpha_, u);
  const Vector3d wi = (2.0 * wo().dot(wm) * wm - wo()).normalized();
  return {wi, acceptance(wi)};
}

std::optional<Vector3d> GgxLobe::sampleByRejection(const Eigen::Vector2d& u, double uAccept) const {
  const LobeSample s = sample(u);
  if (uAccept < s.weight) return s.wi;
  return std::nullopt;
}

void GgxLobe::evalBatch(std::span<const double> x, std::span<const double> y, std::span<const double> z,
                        std::span<double> evalOut, std::span<double> pdfOut) const {
  // Written without branches so that it vectorises: the same sums as eval() and pdf().
  const double ox = wo().x();
  const double oy = wo().y();
  const double oz = wo().z();
  const double ax = alpha_.x;
  const double ay = alpha_.y;
  const double invAx = 1.0 / ax;
  const double invAy = 1.0 / ay;
  const double a = stretchedWo_;
  const double scale = invAx * invAy / (2.0 * std::numbers::pi);
  const double pdfScale = 1.0 / (oz + a);
  const double* const px = x.data();
  const double* const py = y.data();
  const double* const pz = z.data();
  double* const pe = evalOut.data();
  double* const pp = pdfOut.data();
  const std::size_t n = x.size();
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) {
    const double wx = px[i];
    const double wy = py[i];
    const double wz = pz[i];
    const double hx = ox + wx;
    const double hy = oy + wy;
    const double hz = oz + wz;
    const double sx = hx * invAx;
    const double sy = hy * invAy;
    const double ratio = (hx * hx + hy * hy + hz * hz) / (sx * sx + sy * sy + hz * hz);
    const double d = hz > 0.0 ? scale * ratio * ratio : 0.0;
    const double tx = ax * wx;
    const double ty = ay * wy;
    const double ai = std::sqrt(wz * wz + tx * tx + ty * ty);
    const double up = wz > 0.0 ? wz : 0.0;
    // wz <= 0 makes the numerator 0; the tiny term only keeps 0/0 out of that case
    pe[i] = d * up / (a * up + ai * oz + 1e-300);
    pp[i] = d * pdfScale;
  }
}

void GgxLobe::sampleBatch(std::span<const double> u0, std::span<const double> u1, std::span<double> x,
                          std::span<double> y, std::span<double> z, std::span<double> weight) const {
  // sampleGgxVisibleNormal, reflected, and acceptance, in a form that vectorises.
  const Vector3d v = Vector3d(alpha_.x * wo().x(), alpha_.y * wo().y(), wo().z()).normalized();
  const double length = v.head<2>().norm();
  const Vector3d t1 = length > 0.0 ? Vector3d(-v.y() / length, v.x() / length, 0.0) : Vector3d::UnitX();
  const Vector3d t2 = v.cross(t1);
  const double squeeze = 0.5 * (1.0 + v.z());
  const double ox = wo().x();
  const double oy = wo().y();
  const double oz = wo().z();
  const double ax = alpha_.x;
  const double ay = alpha_.y;
  const double a = stretchedWo_;
  const double t1x = ax * t1.x();
  const double t1y = ay * t1.y();
  const double t2x = ax * t2.x();
  const double t2y = ay * t2.y();
  const double t2z = t2.z();
  const double vx = ax * v.x();
  const double vy = ay * v.y();
  const double vz = v.z();
  const double* const p0 = u0.data();
  const double* const p1 = u1.data();
  double* const px = x.data();
  double* const py = y.data();
  double* const pz = z.data();
  double* const pw = weight.data();
  const std::size_t n = u0.size();
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) {
    const double r = std::sqrt(p0[i]);
    double sine;
    double cosine;
    sinCos(2.0 * std::numbers::pi * (p1[i] - 0.5), sine, cosine);  // of the opposite direction
    const double c1 = -r * cosine;
    const double in = 1.0 - c1 * c1;
    const double c2 = (1.0 - squeeze) * std::sqrt(in > 0.0 ? in : 0.0) - squeeze * r * sine;
    const double under = in - c2 * c2;
    const double c3 = std::sqrt(under > 0.0 ? under : 0.0);
    const double mx = c1 * t1x + c2 * t2x + c3 * vx;
    const double my = c1 * t1y + c2 * t2y + c3 * vy;
    const double up = c2 * t2z + c3 * vz;
    const double mz = up > 0.0 ? up : 0.0;
    const double twice = 2.0 * (ox * mx + oy * my + oz * mz) / (mx * mx + my * my + mz * mz);
    const double wx = twice * mx - ox;
    const double wy = twice * my - oy;
    const double wz = twice * mz - oz;
    const double tx = ax * wx;
    const double ty = ay * wy;
    const double ai = std::sqrt(wz * wz + tx * tx + ty * ty);
    const double above = wz > 0.0 ? wz : 0.0;
    px[i] = wx;
    py[i] = wy;
    pz[i] = wz;
    pw[i] = (oz + a) * above / (a * above + ai * oz + 1e-300);  // as in evalBatch
  }
}

StretchedNode GgxLobe::atStretched(const Vector3d& s) const {
  const Vector3d h(alpha_.x * s.x(), alpha_.y * s.y(), s.z());
  const double length = h.norm();
  const Vector3d wm = h / length;
  const double cosine = wo().dot(wm);
  const Vector3d wi = (2.0 * cosine * wm - wo()).normalized();
  if (cosine <= 0.0 || wi.z() <= 0.0) return {wi, 0.0};
  // eval / D * 4 wo.wm * s.z / (pi wm.z), with s.z / wm.z = |h|
  const double masked = stretchedWo_ * wi.z() + stretchedLength(wi, alpha_) * wo().z();
  return {wi, 2.0 * std::numbers::inv_pi * length * cosine * wi.z() / masked};
}

StretchedMap GgxLobe::toStretched() const {
  const Vector3d stretch(1.0 / alpha_.x, 1.0 / alpha_.y, 1.0);
  return {stretch.cwiseProduct(wo()), stretch.asDiagonal()};
}

Eigen::Vector2d GgxLobe::stretchedAzimuth() const {
  const Eigen::Vector2d g(alpha_.x * wo().x(), alpha_.y * wo().y());
  const double length = g.norm();
  return length > 0.0 ? Eigen::Vector2d(g / length) : Eigen::Vector2d::UnitX();
}

double GgxLobe::stretchedHorizon(const Eigen::Vector2d& azimuth) const {
  // A normal at angle beta from n towards an azimuth m reflects wo to wi.z = (wo.m) sin 2 beta + wo.z cos 2
  // beta, which is 0 first at beta = pi/4 + atan2(wo.m, wo.z) / 2.
  const Eigen::Vector2d m(alpha_.x * azimuth.x(), alpha_.y * azimuth.y());
  const double length = m.norm();
  const double along = wo().head<2>().dot(m) / length;
  const double r = std::hypot(along, wo().z());
  // tan beta = (r + along) / wo.z, as a fraction without cancellation; then stretched
  const double rise = along >= 0.0 ? r + along : wo().z();
  const double run = along >= 0.0 ? wo().z() : r - along;
  const double sine = rise;
  const double cosine = run * length;
  const double norm = std::hypot(sine, cosine);
  return norm > 0.0 ? sine / (norm + cosine) : 0.0;
}

Eigen::Vector4d GgxLobe::stretched(const Vector3d& wi) const {
  const Vector3d h = wo() + wi;
  const Vector3d s(h.x() / alpha_.x, h.y() / alpha_.y, h.z());
  const double inv = 1.0 / s.norm();
  // at wo.z = 0 the layer has no thickness, and all of the upper hemisphere is on one side of it
  return {inv * s.x(), inv * s.y(), inv * s.z(), wo().z() > 0.0 ? acceptance(wi) : 1.0};
}

}  // namespace ltcfit
