#include "render/textured_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ltcfit {
namespace {

// Bounds far beyond what any texture resolves, so that squares stay finite in float32 too.
constexpr double kFarthest = 1e9;     // of the point from the light, in sides of the light
constexpr double kLeastArea = 1e-20;  // squared, of a light with sides of about 1
constexpr double kLeastVariance = 1e-12;

}  // namespace

TextureFetch textureFetch(const Eigen::Matrix3d& inverse, std::span<const Eigen::Vector3d, 4> vertices) {
  // of what is scaled first nothing overflows
  double largest = 1e-37;
  for (const Eigen::Vector3d& v : vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  const Eigen::Matrix3d unit = inverse / std::max(inverse.cwiseAbs().maxCoeff(), 1e-37);
  const Eigen::Vector3d diagonal1 = unit * ((vertices[2] - vertices[0]) / largest);
  const Eigen::Vector3d diagonal2 = unit * ((vertices[3] - vertices[1]) / largest);
  Eigen::Vector3d side1 = 0.5 * (diagonal1 - diagonal2);
  Eigen::Vector3d side2 = 0.5 * (diagonal1 + diagonal2);
  const double scale = std::max({side1.cwiseAbs().maxCoeff(), side2.cwiseAbs().maxCoeff(), 1e-37});
  side1 /= scale;
  side2 /= scale;
  const Eigen::Vector3d centre =
      unit * ((vertices[0] + vertices[1] + vertices[2] + vertices[3]) / (4.0 * largest));
  const Eigen::Vector3d q = (-centre / scale).cwiseMax(-kFarthest).cwiseMin(kFarthest);
  const Eigen::Vector3d normal = side1.cross(side2);
  const double area2 = std::max(normal.squaredNorm(), kLeastArea);
  TextureFetch fetch;
  fetch.uv.x() = 0.5 + q.cross(side2).dot(normal) / area2;
  fetch.uv.y() = 0.5 + side1.cross(q).dot(normal) / area2;
  const double distance = std::min(std::abs(q.dot(normal)) / area2, kFarthest);
  fetch.sigma = std::sqrt(std::max(0.5 * distance * distance * std::sqrt(area2), kLeastVariance));
  return fetch;
}

Eigen::Vector3d sampleTrilinear(const PrefilteredTexture& texture, const Eigen::Vector2d& uv, double lod) {
  const auto last = static_cast<double>(texture.levels.size() - 1);
  lod = std::clamp(lod, 0.0, last);
  const auto low = static_cast<std::size_t>(lod);
  const Eigen::Array2d at = (uv.array() + texture.margin) / (1.0 + 2.0 * texture.margin);
  const auto read = [&](std::size_t l) {
    const auto size = static_cast<double>(texture.levels[l].size);
    return bilinear(texture.levels[l], at.x() * size - 0.5, at.y() * size - 0.5);
  };
  const double f = lod - static_cast<double>(low);
  return f > 0.0 ? Eigen::Vector3d((1.0 - f) * read(low) + f * read(low + 1)) : read(low);
}

Eigen::Vector3d fetchPrefiltered(const PrefilteredTexture& texture, const Eigen::Matrix3d& inverse,
                                 std::span<const Eigen::Vector3d, 4> vertices) {
  const TextureFetch fetch = textureFetch(inverse, vertices);
  return sampleTrilinear(texture, fetch.uv, lodOfSigma(texture, fetch.sigma));
}

}  // namespace ltcfit
