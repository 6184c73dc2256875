#include "render/light_textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "ggx/random.h"

namespace ltcfit {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// `colour` of the texture coordinates of each texel's centre.
template <typename Colour>
LightTexture painted(const char* name, std::size_t size, const Colour& colour) {
  LightTexture texture{name, size, size, {}};
  texture.texels.reserve(size * size);
  const auto side = static_cast<double>(size);
  for (std::size_t y = 0; y < size; ++y)
    for (std::size_t x = 0; x < size; ++x)
      texture.texels.push_back(
          colour(Vector2d((static_cast<double>(x) + 0.5) / side, (static_cast<double>(y) + 0.5) / side)));
  return texture;
}

// Saturated, of a hue in turns.
Vector3d hue(double turn) {
  const auto channel = [&](double shift) {
    return 0.02 + 0.98 * std::clamp(std::abs(std::fmod(turn + shift, 1.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
  };
  return {channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0)};
}

}  // namespace

LightTexture colourGradient(std::size_t size) {
  return painted("gradient", size, [](const Vector2d& uv) {
    return Vector3d(0.05 + 0.95 * uv.x(), 0.05 + 0.95 * uv.y(), 1.0 - 0.475 * (uv.x() + uv.y()));
  });
}

LightTexture stainedGlass(std::size_t size, std::uint64_t seed) {
  constexpr std::size_t kCells = 7;  // along a side, one point in each
  constexpr double kLead = 0.012;    // half a line's width
  Random random(seed);
  std::vector<std::pair<Vector2d, Vector3d>> cells;
  for (std::size_t i = 0; i < kCells * kCells; ++i) {
    const std::size_t row = i / kCells;
    const double x = static_cast<double>(i % kCells) + random.uniform();
    const double y = static_cast<double>(row) + random.uniform();
    const double turn = random.uniform();
    const double light = 0.35 + 0.65 * random.uniform();
    cells.emplace_back(Vector2d(x, y) / static_cast<double>(kCells), light * hue(turn));
  }
  return painted("stained-glass", size, [&](const Vector2d& uv) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if ((cells[i].first - uv).squaredNorm() < (cells[nearest].first - uv).squaredNorm()) nearest = i;
    double border = std::min({uv.x(), uv.y(), 1.0 - uv.x(), 1.0 - uv.y()});
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i == nearest) continue;
      const Vector2d between = cells[i].first - cells[nearest].first;
      const Vector2d middle = 0.5 * (cells[i].first + cells[nearest].first);
      border = std::min(border, (middle - uv).dot(between) / between.norm());
    }
    const double glass = std::clamp((border - kLead) * static_cast<double>(size) + 0.5, 0.0, 1.0);
    return Vector3d(Vector3d::Constant(0.005) + glass * (cells[nearest].second - Vector3d::Constant(0.005)));
  });
}

LightTexture diskMask(std::size_t size) {
  constexpr double kRadius = 0.35;
  return painted("disk", size, [&](const Vector2d& uv) {
    const double inside = kRadius - (uv - Vector2d(0.5, 0.5)).norm();
    return Vector3d(Vector3d::Constant(std::clamp(inside * static_cast<double>(size) + 0.5, 0.0, 1.0)));
  });
}

LightTexture checker(std::size_t size, std::size_t squares) {
  return painted("checker", size, [&](const Vector2d& uv) {
    const Vector2d at = uv * static_cast<double>(squares);
    const bool odd = (static_cast<long>(at.x()) + static_cast<long>(at.y())) % 2 != 0;
    return odd ? Vector3d(0.02, 0.03, 0.15) : Vector3d(1.0, 0.9, 0.75);
  });
}

}  // namespace ltcfit
