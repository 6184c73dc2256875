// Rendered films as pictures for people.
#pragma once

#include <string>
#include <vector>

#include "export/png.h"
#include "render/film.h"

namespace ltcfit {

/// Linear radiance 0..1 as sRGB; what is above is white, pixels that are not finite are magenta. Each pixel
/// becomes a square of `zoom` pixels, at least 1.
Picture toPicture(const Film& film, std::size_t zoom = 1);

/// By how much differences are amplified in pictures.
inline constexpr double kDifferenceGain = 5.0;

/// `gain` times the absolute difference where both show a surface, 0 elsewhere. Films of one size, else the
/// program aborts.
Film difference(const Film& a, const Film& b, double gain);

/// One row of a contact sheet: a caption above its pictures.
struct SheetRow {
  std::string caption;  ///< ASCII; letters are drawn as capitals, unknown characters as blanks
  std::vector<Picture> pictures;
};

/// The rows below one another, each picture under the heading of its column, which is cut to its width; rows
/// may have fewer pictures than there are headings. Dark background.
Picture contactSheet(const std::vector<std::string>& headings, const std::vector<SheetRow>& rows);

}  // namespace ltcfit
