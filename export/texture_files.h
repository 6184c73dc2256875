// Tables in texture files: the packing and its metadata go into the container, and come back out of it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "export/dds.h"
#include "export/ktx2.h"
#include "export/packing.h"

namespace ltcfit {

/// A file to be written: its name within the folder that the user chose, and all of its bytes.
struct ExportFile {
  std::string name;
  std::string bytes;
};

/// The textures as layers of one array (isotropic) or on top of each other along z (anisotropic: texture t
/// begins at slice t * n_alpha * n_lambda). All textures of the packing have one size.
Image stackedImage(const PackedTable& packed);

/// The inverse: as many images as the packing has textures. Refusal where the image's size does
/// not fit them.
std::vector<Image> unstackedImages(const Image& stack, const PackedTable& packed);

/// Each returns the file `name`, and where the format has no place for metadata a sidecar for every file,
/// with their checksums. KTX2, DDS and NumPy files hold textures of as many components each; where these
/// differ "x.dds" becomes "x-1.dds", "x-2.dds", each with a sidecar. Exceptions of the containers pass
/// through.
std::vector<ExportFile> toKtx2Files(const PackedTable& packed, Ktx2Compression compression,
                                    const std::string& name);
/// kDx10: one file, an array or a volume. kLegacy, which has no arrays: a file a texture for an isotropic
/// table.
std::vector<ExportFile> toDdsFiles(PackedTable packed, DdsHeader header, const std::string& name);
/// One texture each, under the names told.
std::vector<ExportFile> toDdsFiles(PackedTable packed, DdsHeader header,
                                   const std::vector<std::string>& names);
/// One image: a row for each pair of the two slowest axes' nodes (or node of the slowest of two axes), a
/// column for each of the fastest: 64 x 64 for the 8^4 table, x = phi + 8 theta, y = lambda + 8 alpha.
/// Channels named after the coefficients where the packing has one texture, else R, G, B, A for the first and
/// NAME.R, ... for the others. Metadata in the attribute "ltcfit", and its main points in attributes of their
/// own.
std::vector<ExportFile> toExrFiles(const PackedTable& packed, const std::string& name);
/// Shape (axes.., components) for a packing of one texture, (textures, axes.., components) for several.
std::vector<ExportFile> toNpyFiles(const PackedTable& packed, const std::string& name);
/// The textures one after the other, nothing else.
std::vector<ExportFile> toRawFiles(const PackedTable& packed, const std::string& name);
/// Bytes of an engine's own form, with a sidecar.
std::vector<ExportFile> toRawFiles(const PackedTable& packed, std::string bytes, const std::string& name,
                                   const std::string& container);

/// The inverses: `packed`, which is what packedFromMetadata said, with its images. InputError with `name`
/// where the file does not fit it.
PackedTable packedFromStack(PackedTable packed, const Image& stack, const std::string& name);
PackedTable packedFromExr(std::string_view bytes, const std::string& name);
/// Numbers of .npy or raw files.
PackedTable packedFromNumbers(PackedTable packed, const std::vector<float>& numbers, const std::string& name);

/// InputError with `name` where a number of a texture is not finite, by its texel: "texel y 7, x 3, component
/// 2 (m02)", with z and layer where there are several. `components` are the names, or empty.
void refuseNonFinite(const Image& image, const std::vector<std::string>& components, const std::string& name);

/// unpack for what came from a file: InputError with `name`, also for numbers that are not finite.
Table tableFromPacked(const PackedTable& packed, const std::string& name);

/// The key and attribute that holds the metadata.
inline constexpr const char* kMetadataKey = "ltcfit";

}  // namespace ltcfit
