// Prefiltered textures of lights as files: mip maps, and what a shader must know to read them.
#pragma once

#include <string>
#include <vector>

#include "export/image.h"
#include "export/ktx2.h"
#include "export/texture_files.h"

namespace ltcfit {

struct LightTextureFile {
  std::vector<Image> levels;  ///< mip maps down to one texel, square, RGBA with alpha 1
  double margin = 0.0;        ///< of the texture around the picture, on each side, in sides of the picture
  double aspect = 1.0;        ///< width / height of the light that the filter is round on
  double lodScale = 1.0;      ///< level of detail = log2(lodScale sigma)
};

/// The file `name`, by its extension: .ktx2 and .exr hold the metadata (as "ltcfit": JSON, format
/// "ltc-light-texture"), .dds has it in a sidecar with its checksum. `compression` is for KTX2. Throws
/// Refusal for other extensions, std::invalid_argument for levels that are no such mip maps.
std::vector<ExportFile> lightTextureFiles(const LightTextureFile& texture, const std::string& name,
                                          Ktx2Compression compression);

/// Reads such a file. InputError naming it where it is not there, damaged, or of another kind.
LightTextureFile readLightTexture(const std::string& path);

}  // namespace ltcfit
