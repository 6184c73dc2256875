// Which texels of a texture the triangles of a material show.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace ltcfit {

enum class Wrap { kRepeat, kMirror, kClamp };

/// Surface area seen through each texel of one texture.
class UvCoverage {
 public:
  /// All sizes at least 1.
  UvCoverage(std::size_t width, std::size_t height, Wrap wrapU, Wrap wrapV);

  /// A triangle of surface area `area` with texture coordinates (u, v), v downwards. Its area goes in equal
  /// parts to every texel that bilinear filtering reads anywhere on it; where it repeats the texture more
  /// than once to every texel of the rows, or columns, so repeated. Coordinates of more than 2^20, or not
  /// finite: to all texels.
  void add(const std::array<std::array<double, 2>, 3>& uv, double area);

  /// Row by row, 0 where no triangle is.
  const std::vector<float>& areas() const { return areas_; }
  /// Texels that were added to so far: what the calls took, in time.
  std::size_t work() const { return work_; }

 private:
  struct Row {
    std::size_t y = 0;
    std::ptrdiff_t first = 0;
    std::ptrdiff_t last = 0;
  };

  void addTo(const std::vector<Row>& rows, double area);

  std::size_t width_;
  std::size_t height_;
  Wrap wrapU_;
  Wrap wrapV_;
  std::vector<float> areas_;
  std::vector<Row> rows_;
  std::size_t work_ = 0;
};

}  // namespace ltcfit
