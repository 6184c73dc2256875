// The component types of glTF accessors.
#pragma once

#include <array>
#include <cstddef>

namespace ltcfit {

struct GltfComponent {
  int type;          ///< as files have it
  const char* name;  ///< as the specification has it
  std::size_t size;  ///< bytes
  bool index;        ///< indices may have it
};

/// All that there are (glTF 2.0, 3.6.2.2). OpenGL's INT and DOUBLE, between and beyond them, are not of glTF.
inline constexpr std::array<GltfComponent, 6> kGltfComponents{{{5120, "BYTE", 1, false},
                                                               {5121, "UNSIGNED_BYTE", 1, true},
                                                               {5122, "SHORT", 2, false},
                                                               {5123, "UNSIGNED_SHORT", 2, true},
                                                               {5125, "UNSIGNED_INT", 4, true},
                                                               {5126, "FLOAT", 4, false}}};

}  // namespace ltcfit
