#include "scene/gltf_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "export/atomic_file.h"
#include "scene/gltf_uri.h"

namespace ltcfit {
namespace {


const GltfJson* find(const GltfJson& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

void require(bool right, const std::string& where, std::string_view key, const char* what) {
  if (!right) throw InputError(fmt::format("{}: {} is not {}", where, shortened(std::string(key)), what));
}

void checkNumber(const GltfJson& object, const std::string& where, const char* key) {
  if (const GltfJson* value = find(object, key)) require(value->is_number(), where, key, "a number");
}

void checkColor(const GltfJson& object, const std::string& where, const char* key) {
  const GltfJson* value = find(object, key);
  if (value == nullptr) return;
  const bool numbers = value->is_array() &&
                       std::all_of(value->begin(), value->end(), [](const GltfJson& x) { return x.is_number(); });
  require(numbers, where, key, "a colour");
}

void checkTexture(const GltfJson& object, const std::string& where, const char* key) {
  const GltfJson* info = find(object, key);
  if (info == nullptr) return;
  require(info->is_object(), where, key, "an object");
  const GltfJson* index = find(*info, "index");
  require(index != nullptr && index->is_number_integer(), where, fmt::format("index of {}", key),
          "an integer");
  if (const GltfJson* set = find(*info, "texCoord"))
    require(set->is_number_integer(), where, fmt::format("texCoord of {}", key), "an integer");
}

void checkMaterial(const GltfJson& material, const std::string& where) {
  if (const GltfJson* pbr = find(material, "pbrMetallicRoughness")) {
    require(pbr->is_object(), where, "pbrMetallicRoughness", "an object");
    checkNumber(*pbr, where, "roughnessFactor");
    checkNumber(*pbr, where, "metallicFactor");
    checkColor(*pbr, where, "baseColorFactor");
    checkTexture(*pbr, where, "metallicRoughnessTexture");
    checkTexture(*pbr, where, "baseColorTexture");
  }
  checkColor(material, where, "emissiveFactor");
  checkTexture(material, where, "emissiveTexture");
  if (const GltfJson* sides = find(material, "doubleSided"))
    require(sides->is_boolean(), where, "doubleSided", "true or false");
  const GltfJson* extensions = find(material, "extensions");
  if (extensions == nullptr) return;
  require(extensions->is_object(), where, "extensions", "an object");
  for (const auto& [key, value] : extensions->items())
    if (key.starts_with("KHR_materials_")) require(value.is_object(), where, key, "an object");
}

}  // namespace

void checkMaterialTypes(const GltfJson& materials) {
  std::size_t i = 0;
  for (const GltfJson& material : materials) {
    if (!material.is_object()) throw InputError(fmt::format("material {} is not an object", i));
    const GltfJson* name = find(material, "name");
    const bool named = name != nullptr && name->is_string() && !name->get_ref<const std::string&>().empty();
    checkMaterial(material, named ? fmt::format("Material '{}'", shortened(name->get<std::string>()))
                                  : fmt::format("Material {}", i));
    ++i;
  }
}

}  // namespace ltcfit
