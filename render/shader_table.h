// A table's file as the textures that ltc.glsl reads.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "export/image.h"
#include "ltc/table.h"

namespace ltcfit {

/// Textures and the table that is in them.
struct ShaderTable {
  /// Isotropic: matrix (4 components) and amplitude (2 or 4) by x = alpha and y = theta. Anisotropic: one
  /// volume, the rows of M on top of each other. As the head of ltc.glsl says.
  std::vector<Image> textures;
  /// The very numbers of the textures, for look-ups in double: the inverse (isotropic) or M.
  Table table;
  std::string note;  ///< where the texels come from, in words

  bool isIsotropic() const { return table.isIsotropic(); }
  /// (n_alpha, n_lambda) of an anisotropic table.
  std::array<std::size_t, 2> nodes() const {
    return {table.info().axes[0].size(), table.info().axes[1].size()};
  }
};

/// Reads whatever readTable reads. A file of textures in the layout of ltc.glsl gives its own texels, in its
/// own precision; anything else is packed into it, in float32, as the exporter does. Norm and Fresnel of a
/// table that has none are looked up in `amplitudes` at the nodes, if given, which changes no matrix. Throws
/// InputError: not readable; axes that ltc.glsl does not address; no norm or Fresnel, and none to be had.
ShaderTable loadShaderTable(const std::string& path, const Table* amplitudes = nullptr);

}  // namespace ltcfit
