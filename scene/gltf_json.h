// The JSON of glTF files.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace ltcfit {

/// Keys in the order of the alphabet, as tinygltf keeps them.
using GltfJson = nlohmann::json;

/// Parses the JSON of a glTF file, with zeros at its end or not. InputError for what is not JSON, more than
/// kMaxGltfJson bytes, more than kMaxGltfJsonMemory bytes of objects, nesting of more than 64 and integers
/// beyond 32 bits outside of "extras": tinygltf recurses, and cuts integers off.
GltfJson parseGltfJson(std::string_view text);

}  // namespace ltcfit
