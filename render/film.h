// Rendered pictures: linear radiance, and what each pixel shows.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ltcfit {

enum class PixelKind : std::uint8_t {
  kBackground,  ///< nothing: black
  kLight,       ///< a light seen directly: its radiance
  kSurface,     ///< a lit surface: the only pixels that figures count
};

struct Film {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Eigen::Vector3d> radiance;  ///< linear RGB, row by row from the top; lights emit 1 unless told
  std::vector<PixelKind> kinds;           ///< of each pixel

  Film() = default;
  Film(std::size_t w, std::size_t h)
      : width(w), height(h), radiance(w * h, Eigen::Vector3d::Zero()), kinds(w * h, PixelKind::kBackground) {}
};

}  // namespace ltcfit
