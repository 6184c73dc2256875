// What a texture's numbers mean, as text: in the file where its format has a place, else beside it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "export/packing.h"

namespace ltcfit {

/// How textures lie in files without a header of their own (the `container` of their metadata).
inline constexpr const char* kRawContainer = "texture after texture, little-endian, no header";
inline constexpr const char* kBabylonContainer = "8 halves a texel: the first texture's, then the second's";
inline constexpr const char* kPlayCanvasContainer =
    "int16 0, int16 1, then texture after texture, little-endian";

/// The sidecar of a file: "table.dds" has "table.dds.json".
std::string sidecarPath(const std::string& path);

/// JSON, format "ltc-texture", version 1: the table file's header (axes, brdf, alpha_floor, provenance) and,
/// for the numbers, which matrix, divided by what, in which component of which texture, in what order, in
/// which precision; with the formulas a shader needs. `container` says how the textures lie in the file
/// ("layers", "stacked in depth", ...). No image.
std::string textureMetadata(const PackedTable& packed, const std::string& container);

/// The same on one line for the end of a source file: "ltcfit-metadata: {..}". It ends no comment of C or
/// JavaScript.
std::string metadataLine(const PackedTable& packed, const std::string& container);

/// The JSON of that line, wherever it is in a text; nothing where there is no such line, and no JSON where it
/// is cut off.
std::optional<std::string> metadataOfSource(std::string_view text);

/// "Minv, the inverse of M, divided by m11, m{row}{column}, times column vectors" and the like.
std::string matrixText(const PackedTable& packed);

/// Lines that tell a reader of source code what the arrays hold: origin, matrix, components, coordinates,
/// nodes. None ends a comment.
std::vector<std::string> describeTextures(const PackedTable& packed);

bool isTextureMetadata(std::string_view text);

/// Everything of a PackedTable but its images and report. InputError naming the field.
PackedTable packedFromMetadata(std::string_view text, const std::string& name);

}  // namespace ltcfit
