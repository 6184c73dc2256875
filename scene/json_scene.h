// Scenes described by hand, for those that are in no glTF file.
#pragma once

#include <filesystem>
#include <string_view>

#include "scene/scene_use.h"

namespace ltcfit {

/// Whether the bytes are meant as a description: JSON text that begins as an object and has "ltc-scene" in
/// it.
bool isSceneDescription(std::string_view bytes);

/// Reads a description; data/scenes/ltc-scene.schema.json is the same as a JSON Schema.
///
///   {"format": "ltc-scene", "version": 1,
///    "$schema": "ltc-scene.schema.json",    optional, for editors; not read
///    "name": "lobby",                       optional; the file's otherwise
///    "materials": [                         at least one
///      {"name": "floor",
///       "roughness": 0.4,                   root of the GGX alpha, 0..1
///       "anisotropy": [0, 0.5],             optional: strength as in glTF, alpha_x = mix(roughness^2, 1,
///       strength^2) "f0": 0.04, "f90": 1,               optional, 0..1: reflectance, by default 0.04 and 1
///       "area": 2.5},                       optional: surface, in any one unit, for all materials or none
///      {"name": "lift", "alpha_x": 0.3, "alpha_y": 0.1}],   in place of roughness and anisotropy; in any
///      order
///    "lights": ["polygon", "disk", "sphere", "textured"],   optional: the kinds that there are
///    "light_sides": ["one", "two"],         optional, "one" where there are lights
///    "views": [0, 85]}                      optional: angles from the normal, degrees, 0..90
///
/// roughness, anisotropy, alpha_x, alpha_y, f0 and f90 are each a number, or
///   [0.3, 0.7]                              even over this range (of sqrt(alpha) for alpha_x and alpha_y),
///   sampled
///                                           at 65 values, ends included
///   {"values": [0.2, 0.6], "weights": [3, 1]}   some values; weights optional
///   {"image": "rough.png", "channel": "g", "scale": 0.5}   what a PNG or JPEG beside the file holds, linear,
///   channel
///                                           r, g, b or a, times scale (1 by default).
/// They are taken as independent of each other; those of one material may have 2^22 combinations, and the
/// lobes of all kMaxLobeBytes (scene_use.h).
///
/// InputError, without the file's name, for more than 1 MiB and anything else: unknown fields, wrong types,
/// numbers out of range, by name.
SceneUse sceneFromJson(std::string_view bytes, const std::filesystem::path& folder);

}  // namespace ltcfit
