// A table's file as the textures that ltc.glsl, or the look-up made for the table, reads.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "export/image.h"
#include "export/read_table.h"
#include "export/shader_lookup.h"
#include "ltc/table.h"

namespace ltcfit {

/// Textures and the table that is in them.
struct ShaderTable {
  /// Isotropic: matrix (4 components) and amplitude (2 or 4) by x = alpha and y = theta. Anisotropic: one
  /// volume, the rows of M on top of each other. As the head of ltc.glsl says; packingLean for a look-up of
  /// its own.
  std::vector<Image> textures;
  /// The very numbers of the textures, for look-ups in double: the inverse (isotropic) or M.
  Table table;
  std::string note;  ///< where the texels come from, in words
  /// In GLSL, of a table whose axes ltc.glsl does not address or that has no fresnel; nothing for others.
  std::optional<ShaderLookup> lookup;

  bool isIsotropic() const { return table.isIsotropic(); }
  bool hasFresnel() const;
  /// (n_alpha, n_lambda) of an anisotropic table.
  std::array<std::size_t, 2> nodes() const {
    return {table.info().axes[0].size(), table.info().axes[1].size()};
  }
};

/// Reads whatever readTable reads. A file of textures in the layout of the look-up gives its own texels, in
/// its own precision; anything else is packed into it, in float32, as the exporter does. Norm and Fresnel
/// that a table lacks are looked up in `amplitudes` at the nodes, if given, which changes no matrix. Throws
/// InputError: not readable; an axis that no shader looks up (makeShaderLookup); no norm, and none to be had.
ShaderTable loadShaderTable(const std::string& path, const Table* amplitudes = nullptr);
/// The same of a file that was read; `path` is its name in messages.
ShaderTable makeShaderTable(TableFile file, const std::string& path, const Table* amplitudes = nullptr);

}  // namespace ltcfit
