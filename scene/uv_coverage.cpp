#include "scene/uv_coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ltcfit {
namespace {

using Point = std::array<double, 2>;

// Calls `visit` with every texel that first..last, counted without wrapping, stands for.
template <typename Visit>
void forEachWrapped(std::ptrdiff_t first, std::ptrdiff_t last, std::size_t size, Wrap wrap,
                    const Visit& visit) {
  const auto n = static_cast<std::ptrdiff_t>(size);
  const std::ptrdiff_t period = wrap == Wrap::kMirror ? 2 * n : n;
  if (wrap == Wrap::kClamp) {
    first = std::clamp<std::ptrdiff_t>(first, 0, n - 1);
    last = std::clamp<std::ptrdiff_t>(last, 0, n - 1);
  } else if (last - first + 1 >= period) {
    first = 0;
    last = n - 1;
  }
  for (std::ptrdiff_t i = first; i <= last; ++i) {
    std::ptrdiff_t k = i % period;
    if (k < 0) k += period;
    visit(static_cast<std::size_t>(k < n ? k : period - 1 - k));
  }
}

// The texels i with |x - i| < 1 for an x of low..high: what a linear filter reads.
std::array<std::ptrdiff_t, 2> texelsOf(double low, double high) {
  return {static_cast<std::ptrdiff_t>(std::floor(low)), static_cast<std::ptrdiff_t>(std::ceil(high))};
}

// The range of x that the triangle has within y of low..high.
std::array<double, 2> rangeWithin(const std::array<Point, 3>& triangle, double low, double high) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  const auto take = [&](double x) {
    least = std::min(least, x);
    most = std::max(most, x);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& a = triangle[i];
    const Point& b = triangle[(i + 1) % 3];
    if (a[1] >= low && a[1] <= high) take(a[0]);
    for (const double y : {low, high})
      if ((a[1] < y) != (b[1] < y)) take(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
  }
  return {least, most};
}

}  // namespace

UvCoverage::UvCoverage(std::size_t width, std::size_t height, Wrap wrapU, Wrap wrapV)
    : width_(width), height_(height), wrapU_(wrapU), wrapV_(wrapV), areas_(width * height, 0.0f) {}

void UvCoverage::add(const std::array<Point, 3>& uv, double area) {
  constexpr double kMost = 1 << 20;
  std::array<Point, 3> triangle{};
  bool sane = true;
  for (std::size_t i = 0; i < 3; ++i) {
    sane = sane && std::abs(uv[i][0]) <= kMost && std::abs(uv[i][1]) <= kMost;
    // texel centres at whole numbers
    triangle[i] = {uv[i][0] * static_cast<double>(width_) - 0.5,
                   uv[i][1] * static_cast<double>(height_) - 0.5};
  }
  rows_.clear();
  const auto w = static_cast<std::ptrdiff_t>(width_);
  const auto h = static_cast<std::ptrdiff_t>(height_);
  if (!sane) {
    for (std::size_t y = 0; y < height_; ++y) rows_.push_back({y, 0, w - 1});
    addTo(rows_, area);
    return;
  }
  const auto [lowX, highX] = std::minmax({triangle[0][0], triangle[1][0], triangle[2][0]});
  const auto [lowY, highY] = std::minmax({triangle[0][1], triangle[1][1], triangle[2][1]});
  auto [top, bottom] = texelsOf(lowY, highY);
  const bool clamped = wrapV_ == Wrap::kClamp;
  if (clamped) {
    top = std::clamp<std::ptrdiff_t>(top, 0, h - 1);
    bottom = std::clamp<std::ptrdiff_t>(bottom, 0, h - 1);
  }
  const std::ptrdiff_t period = wrapV_ == Wrap::kMirror ? 2 * h : h;
  const auto [left, right] = texelsOf(lowX, highX);
  if (!clamped && bottom - top + 1 >= period) {
    for (std::size_t y = 0; y < height_; ++y) rows_.push_back({y, left, right});
  } else {
    for (std::ptrdiff_t j = top; j <= bottom; ++j) {
      const double centre = static_cast<double>(j);
      // all that lies beyond a clamped edge reads its row
      const double low = clamped && j == 0 ? lowY : std::max(lowY, centre - 1.0);
      const double high = clamped && j == h - 1 ? highY : std::min(highY, centre + 1.0);
      const auto [least, most] = rangeWithin(triangle, low, high);
      const auto [first, last] = texelsOf(least, most);
      forEachWrapped(j, j, height_, wrapV_, [&, f = first, l = last](std::size_t y) {
        rows_.push_back({y, f, l});
      });
    }
  }
  addTo(rows_, area);
}

void UvCoverage::addTo(const std::vector<Row>& rows, double area) {
  std::size_t count = 0;
  for (const Row& row : rows)
    forEachWrapped(row.first, row.last, width_, wrapU_, [&](std::size_t) { ++count; });
  const float each =
      std::max(static_cast<float>(area / static_cast<double>(count)), std::numeric_limits<float>::min());
  for (const Row& row : rows)
    forEachWrapped(row.first, row.last, width_, wrapU_,
                   [&](std::size_t x) { areas_[row.y * width_ + x] += each; });
  work_ += count;
}

}  // namespace ltcfit
