#include "scene/gltf_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "export/atomic_file.h"
#include "scene/gltf_component.h"
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
  const bool numbers = value->is_array() && std::all_of(value->begin(), value->end(),
                                                        [](const GltfJson& x) { return x.is_number(); });
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

void checkNamedMaterial(const GltfJson& material, const std::string& where) {
  const GltfJson* name = find(material, "name");
  const bool named = name != nullptr && name->is_string() && !name->get_ref<const std::string&>().empty();
  checkMaterial(material, named ? fmt::format("Material '{}'", shortened(name->get<std::string>()))
                                : "M" + where.substr(1));
}

bool isNatural(const GltfJson& value) {
  return value.is_number_unsigned();
}

void checkNatural(const GltfJson& object, const std::string& where, const char* key, bool needed = false) {
  const GltfJson* value = find(object, key);
  if (value == nullptr && !needed) return;
  require(value != nullptr && isNatural(*value), where, key, "an integer from 0 on");
}

void checkArray(const GltfJson& object, const std::string& where, const char* key,
                bool (*right)(const GltfJson&), const char* what) {
  if (const GltfJson* value = find(object, key))
    require(value->is_array() && std::all_of(value->begin(), value->end(), right), where, key, what);
}

// A value of an enumeration, and what the specification calls it.
struct Named {
  GltfJson value;
  std::string name;
};
using Enumeration = std::vector<Named>;

void checkEnumeration(const GltfJson& object, const std::string& where, const char* key,
                      const Enumeration& known, bool needed = false) {
  const GltfJson* value = find(object, key);
  if (value == nullptr && !needed) return;
  std::string all;
  for (const Named& one : known) {
    // 5126.0 equals 5126, and glTF writes integers without a fraction
    if (value != nullptr && value->is_number_float() == one.value.is_number_float() && *value == one.value)
      return;
    all += all.empty() ? "" : ", ";
    all += one.name.empty() ? one.value.get<std::string>()
                            : fmt::format("{} ({})", one.value.get<int>(), one.name);
  }
  throw InputError(fmt::format("{}: {} {}; glTF has {}", where, key,
                               value == nullptr ? "is missing" : "is " + shortened(value->dump()), all));
}

Enumeration componentTypes(bool ofIndices) {
  Enumeration out;
  for (const GltfComponent& component : kGltfComponents)
    if (component.index || !ofIndices) out.push_back({component.type, component.name});
  return out;
}

void checkSparse(const GltfJson& sparse, const std::string& where) {
  static const Enumeration kIndexTypes = componentTypes(true);
  checkNatural(sparse, where, "count", true);
  for (const char* key : {"indices", "values"}) {
    const GltfJson* part = find(sparse, key);
    require(part != nullptr && part->is_object(), where, key, "an object");
    const std::string inner = fmt::format("{}.{}", where, key);
    checkNatural(*part, inner, "bufferView", true);
    checkNatural(*part, inner, "byteOffset");
    // values have that of their accessor
    if (std::string_view(key) == "indices")
      checkEnumeration(*part, inner, "componentType", kIndexTypes, true);
  }
}

void checkAccessor(const GltfJson& accessor, const std::string& where) {
  static const Enumeration kTypes = componentTypes(false);
  static const Enumeration kShapes{{"SCALAR", ""}, {"VEC2", ""}, {"VEC3", ""}, {"VEC4", ""},
                                   {"MAT2", ""},   {"MAT3", ""}, {"MAT4", ""}};
  checkEnumeration(accessor, where, "componentType", kTypes, true);
  checkEnumeration(accessor, where, "type", kShapes, true);
  checkNatural(accessor, where, "count", true);
  checkNatural(accessor, where, "bufferView");
  checkNatural(accessor, where, "byteOffset");
  if (const GltfJson* normalized = find(accessor, "normalized"))
    require(normalized->is_boolean(), where, "normalized", "true or false");
  const GltfJson* sparse = find(accessor, "sparse");
  if (sparse == nullptr) return;
  require(sparse->is_object(), where, "sparse", "an object");
  checkSparse(*sparse, where + ": sparse");
}

void checkView(const GltfJson& view, const std::string& where) {
  checkNatural(view, where, "buffer", true);
  checkNatural(view, where, "byteLength", true);
  checkNatural(view, where, "byteOffset");
  const GltfJson* stride = find(view, "byteStride");
  if (stride == nullptr) return;
  // 0, which glTF does not have, is written for none, and viewers take it so
  const bool right = isNatural(*stride) && *stride <= 252 && stride->get<unsigned>() % 4 == 0;
  require(right, where, fmt::format("byteStride ({})", shortened(stride->dump())),
          "a multiple of 4 from 4 to 252, as glTF has it");
}

void checkSampler(const GltfJson& sampler, const std::string& where) {
  static const Enumeration kWrap{{33071, "CLAMP_TO_EDGE"}, {33648, "MIRRORED_REPEAT"}, {10497, "REPEAT"}};
  static const Enumeration kMagnify{{9728, "NEAREST"}, {9729, "LINEAR"}};
  static const Enumeration kMinify{{9728, "NEAREST"},
                                   {9729, "LINEAR"},
                                   {9984, "NEAREST_MIPMAP_NEAREST"},
                                   {9985, "LINEAR_MIPMAP_NEAREST"},
                                   {9986, "NEAREST_MIPMAP_LINEAR"},
                                   {9987, "LINEAR_MIPMAP_LINEAR"}};
  checkEnumeration(sampler, where, "wrapS", kWrap);
  checkEnumeration(sampler, where, "wrapT", kWrap);
  checkEnumeration(sampler, where, "magFilter", kMagnify);
  checkEnumeration(sampler, where, "minFilter", kMinify);
}

void checkPrimitive(const GltfJson& primitive, const std::string& where) {
  static const Enumeration kModes{{0, "POINTS"},      {1, "LINES"},     {2, "LINE_LOOP"},
                                  {3, "LINE_STRIP"},  {4, "TRIANGLES"}, {5, "TRIANGLE_STRIP"},
                                  {6, "TRIANGLE_FAN"}};
  checkEnumeration(primitive, where, "mode", kModes);
  checkNatural(primitive, where, "indices");
  checkNatural(primitive, where, "material");
  const GltfJson* attributes = find(primitive, "attributes");
  if (attributes == nullptr) return;
  require(attributes->is_object(), where, "attributes", "an object");
  for (const auto& [name, accessor] : attributes->items())
    require(isNatural(accessor), where, name, "an integer from 0 on");
}

void checkNode(const GltfJson& node, const std::string& where) {
  const auto isNumber = [](const GltfJson& value) { return value.is_number(); };
  checkNatural(node, where, "mesh");
  checkArray(node, where, "children", isNatural, "an array of integers, none negative");
  for (const char* key : {"matrix", "rotation", "scale"})
    checkArray(node, where, key, isNumber, "an array of numbers");
}

// Calls `check` with the objects of the array `key`, where there is one, and with the name of each.
void forEach(const GltfJson& json, const char* key, const std::string& what,
             const std::function<void(const GltfJson&, const std::string&)>& check) {
  const GltfJson* array = find(json, key);
  if (array == nullptr || array->is_null()) return;
  if (!array->is_array()) throw InputError(fmt::format("'{}' is not an array", key));
  std::size_t i = 0;
  for (const GltfJson& object : *array) {
    const std::string where = fmt::format("{} {}", what, i++);
    if (!object.is_object()) throw InputError(where + " is not an object");
    check(object, where);
  }
}

}  // namespace

void checkGltfTypes(const GltfJson& json) {
  checkNatural(json, "the file", "scene");
  forEach(json, "scenes", "scene", [](const GltfJson& scene, const std::string& where) {
    checkArray(scene, where, "nodes", isNatural, "an array of integers, none negative");
  });
  forEach(json, "nodes", "node", checkNode);
  forEach(json, "meshes", "mesh", [](const GltfJson& mesh, const std::string& where) {
    forEach(mesh, "primitives", where + ", primitive", checkPrimitive);
  });
  forEach(json, "accessors", "accessor", checkAccessor);
  forEach(json, "bufferViews", "buffer view", checkView);
  forEach(json, "textures", "texture", [](const GltfJson& texture, const std::string& where) {
    checkNatural(texture, where, "source");
    checkNatural(texture, where, "sampler");
  });
  forEach(json, "samplers", "sampler", checkSampler);
  forEach(json, "images", "image",
          [](const GltfJson& image, const std::string& where) { checkNatural(image, where, "bufferView"); });
  forEach(json, "materials", "material", checkNamedMaterial);
}

}  // namespace ltcfit
