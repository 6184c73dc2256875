// What a glTF 2.0 scene uses of the tables.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/scene_use.h"

namespace ltcfit {

/// Reads the bytes of a .gltf or .glb that lies in `folder`, as parseGltf does.
///
/// Counted are the materials of what surfacesOf finds: one MaterialUse for each, one more for its clearcoat,
/// none for KHR_materials_unlit. Their parameters are factors times texels (gltf_material.h), weighted by the
/// area of the triangles that show them (gltf_textures.h) and merged where they are nearly alike
/// (lobe_histogram.h). Shares of area are of all materials with a lobe; equal where geometry is compressed or
/// has no area. Images that are needed and of a kind that is not read (KTX2, WebP, AVIF, DDS) are assumed to
/// hold every value, and a reason says so.
///
/// glTF has no area lights: meshes that emit count as polygons, textured where the emission is. Lights of
/// KHR_lights_punctual have no extent. `lights` is empty, with a reason, where nothing emits.
///
/// InputError, without the file's name, for what is damaged, missing or beyond the limits of those headers.
SceneUse sceneFromGltf(std::string_view bytes, const std::filesystem::path& folder);

}  // namespace ltcfit
