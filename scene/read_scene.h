// Scenes, whatever they are written in.
#pragma once

#include <string>

#include "scene/scene_use.h"

namespace ltcfit {

/// Reads a scene by its content: glTF 2.0 (.glb, or .gltf: JSON with "asset", see gltf_scene.h), or a
/// description of its own (JSON with "format": "ltc-scene", see json_scene.h). InputError naming the file and
/// what is wrong.
SceneUse readScene(const std::string& path);

}  // namespace ltcfit
