// Types and values of what glTF files hold.
#pragma once

#include "scene/gltf_json.h"

namespace ltcfit {

/// InputError, naming object and field, where something that is read here has another type than glTF gives
/// it, an index or length is negative, or an enumeration (component types, accessor types, wrapping, filters,
/// modes of primitives) has a value that glTF does not have; the message lists those that it has. tinygltf
/// takes a default in place of most, silently. `json` is the whole file. Ranges of indices are left to their
/// users, and numbers within extensions of materials to materialFrom, which sees them as they are.
void checkGltfTypes(const GltfJson& json);

}  // namespace ltcfit
