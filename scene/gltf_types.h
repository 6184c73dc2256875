// Types of what glTF materials hold.
#pragma once

#include "scene/gltf_json.h"

namespace ltcfit {

/// InputError, naming material and field, for the materials of a file ("materials", an array) of which
/// something that is read here has another type than glTF gives it: tinygltf takes the default in its place,
/// silently. Numbers within extensions are left to materialFrom, which sees them as they are.
void checkMaterialTypes(const GltfJson& materials);

}  // namespace ltcfit
