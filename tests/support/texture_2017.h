// Textures in the layout of 2017, small enough for text.
#pragma once

#include <string>

#include "export/packing.h"
#include "export/read_table.h"

namespace ltcfit::test {

/// Every ninth texel of the isotropic table of data/ along each side: 8 x 8, one texture of (Minv00, Minv20,
/// Minv02, Minv22), one of (norm, Fresnel, 0, sphere).
inline std::vector<Image> textures2017() {
  const PackedTable packed =
      pack(readTable(std::string(LTCFIT_DATA_DIR) + "/ltc_iso.json"), packing2017(), Precision::kFloat);
  std::vector<Image> small;
  for (const Image& image : packed.images) {
    Image out;
    out.width = out.height = 8;
    for (std::size_t y = 0; y < 64; y += 9) {
      for (std::size_t x = 0; x < 64; x += 9) {
        const auto texel = image.values.begin() + static_cast<std::ptrdiff_t>(4 * (64 * y + x));
        out.values.insert(out.values.end(), texel, texel + 4);
      }
    }
    small.push_back(std::move(out));
  }
  return small;
}

}  // namespace ltcfit::test
