// Lobes as pictures: the true one, the table's, and their difference.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "export/png.h"
#include "ltc/table.h"

namespace ltcfit {

/// A piece of the sphere of directions, flattened so that distances and directions from its middle are kept
/// (azimuthal equidistant). Up in the picture is towards the normal; where the lobe points along it, towards
/// the view.
struct LobeWindow {
  Eigen::Vector3d centre = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  double halfWidth = 1.0;  ///< radians from the middle to the edge, at most pi / 2

  /// The direction at x, y in [-1, 1], x to the right and y up.
  Eigen::Vector3d direction(double x, double y) const;
};

/// About the mean direction of the lobe, one and a half spreads to each side (the spread of SW1rel), 90
/// degrees at most.
LobeWindow lobeWindow(const Eigen::Vector3d& mean, double spread, const Eigen::Vector3d& wo);

inline constexpr std::size_t kPicturePixels = 160;

/// Pictures of one lobe and of the LTCs of some tables.
struct LobePictures {
  LobeWindow window;
  double peak = 0.0;        ///< per steradian: the top of the scale, the largest density of the true lobe
  double difference = 0.0;  ///< per steradian: the scale of differences goes from minus to plus this
  Picture lobe;
  struct Ltc {
    Picture density;     ///< clamped at the peak
    Picture difference;  ///< table - true lobe
  };
  std::vector<std::optional<Ltc>> tables;  ///< in the order given; none for a matrix without an inverse
};

/// Densities are means over each pixel (3 x 3 directions). The largest difference of all tables, or the peak
/// where that is smaller, is the end of the scale of differences. The horizon is drawn where it crosses the
/// window.
LobePictures drawLobe(std::string_view brdf, const LobeParameters& parameters,
                      const std::vector<TableEntry>& entries);

}  // namespace ltcfit
