// The JSON of glTF files.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace ltcfit {

/// Parses the JSON of a glTF file, with zeros at its end or not. InputError for what is not JSON, more than
/// kMaxGltfJson bytes, nesting of more than 64 and integers beyond 32 bits outside of "extras": tinygltf
/// recurses, and cuts integers off.
nlohmann::json parseGltfJson(std::string_view text);

}  // namespace ltcfit
