#include "export/direction_moments.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "ggx/ggx_lobe.h"
#include "ltc/ltc.h"

namespace ltcfit {
namespace {

// Even steps along each of the two numbers that a sample is made of.
constexpr int kSide = 16;
constexpr int kSamples = kSide * kSide;
// Below it every lobe is its mirror direction.
constexpr double kLeastAlpha = 1e-4;

const std::vector<Eigen::Vector2d>& evenPoints() {
  static const std::vector<Eigen::Vector2d> list = [] {
    std::vector<Eigen::Vector2d> out;
    for (int row = 0; row < kSamples / kSide; ++row)
      for (int column = 0; column < kSide; ++column)
        out.emplace_back((column + 0.5) / kSide, (row + 0.5) / kSide);
    return out;
  }();
  return list;
}

const std::vector<Eigen::Vector3d>& cosineDirections() {
  static const std::vector<Eigen::Vector3d> list = [] {
    std::vector<Eigen::Vector3d> out;
    for (const Eigen::Vector2d& u : evenPoints()) out.push_back(sampleCosine(u));
    return out;
  }();
  return list;
}

void addDirection(DirectionMoments& shape, const Eigen::Vector3d& w, double weight) {
  shape.mean += weight * w;
  shape.second += weight * w * w.transpose();
}

}  // namespace

GgxMoments ggxMoments(const LobeParameters& p) {
  const GgxLobe lobe(viewDirection(p.theta, p.phi),
                     {std::max(p.alphaX, kLeastAlpha), std::max(p.alphaY, kLeastAlpha)});
  GgxMoments out;
  for (const Eigen::Vector2d& u : evenPoints()) {
    const LobeSample s = lobe.sample(u);
    if (!(s.weight > 0.0)) continue;
    const double cosine = std::sqrt(std::max(0.0, 0.5 * (1.0 + lobe.wo().dot(s.wi))));  // wo.wm
    addDirection(out.lobe, s.wi, s.weight);
    out.norm += s.weight;
    out.fresnel += s.weight * std::pow(1.0 - cosine, 5);
  }
  out.lobe.mean /= out.norm;
  out.lobe.second /= out.norm;
  out.norm /= kSamples;
  out.fresnel /= kSamples;
  return out;
}

DirectionMoments ltcMoments(const Eigen::Matrix3d& m) {
  DirectionMoments out;
  if (!m.allFinite() || m.determinant() == 0.0) return out;
  for (const Eigen::Vector3d& x : cosineDirections()) addDirection(out, (m * x).normalized(), 1.0 / kSamples);
  return out;
}

double momentDistance(const DirectionMoments& a, const DirectionMoments& b) {
  return std::sqrt((a.mean - b.mean).squaredNorm() + (a.second - b.second).squaredNorm());
}

}  // namespace ltcfit
