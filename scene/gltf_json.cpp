#include "scene/gltf_json.h"

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "export/atomic_file.h"
#include "scene/gltf_file.h"
#include "scene/gltf_uri.h"
#include "scene/json_text.h"

namespace ltcfit {
namespace {

// No file of Khronos reaches 16.
constexpr int kMaxDepth = 64;

// Bytes that the parser's tree takes for a value, a key and an object or array, allocation included.
constexpr std::size_t kValueBytes = 32;
constexpr std::size_t kKeyBytes = 96;
constexpr std::size_t kContainerBytes = 64;

// Bytes of what tinygltf makes of an object in an array of the file; 0 of arrays that it is not given.
std::size_t objectBytes(std::string_view array) {
  static const std::map<std::string_view, std::size_t> kBytes{
      {"accessors", sizeof(tinygltf::Accessor)}, {"bufferViews", sizeof(tinygltf::BufferView)},
      {"buffers", sizeof(tinygltf::Buffer)},     {"images", sizeof(GltfImage)},
      {"materials", sizeof(tinygltf::Material)}, {"meshes", sizeof(tinygltf::Mesh)},
      {"nodes", sizeof(tinygltf::Node)},         {"samplers", sizeof(tinygltf::Sampler)},
      {"scenes", sizeof(tinygltf::Scene)},       {"textures", sizeof(tinygltf::Texture)}};
  const auto found = kBytes.find(array);
  return found == kBytes.end() ? 0 : found->second;
}

// Looks at the JSON before it is kept. (The parser's own callbacks search an object or array anew after each
// of its members: 200000 of them take minutes.)
class Limits : public nlohmann::json_sax<GltfJson> {
 public:
  bool null() override { return scalar(); }
  bool boolean(bool) override { return scalar(); }
  bool number_integer(number_integer_t value) override {
    if (value < std::numeric_limits<std::int32_t>::min()) refuse(std::to_string(value));
    return scalar();
  }
  bool number_unsigned(number_unsigned_t value) override {
    if (value > std::uint64_t{std::numeric_limits<std::int32_t>::max()}) refuse(std::to_string(value));
    return scalar();
  }
  bool number_float(number_float_t, const string_t&) override { return scalar(); }
  bool string(string_t&) override { return scalar(); }
  bool binary(binary_t&) override { return scalar(); }
  bool start_object(std::size_t) override { return open(true); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(false); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    if (extras_ == 0 && name == "extras") extras_ = depth_ + 1;
    if (copied_ == 0 && (name == "extras" || name == "extensions")) copied_ = depth_ + 1;
    if (depth_ == 1) array_ = name;
    take(kKeyBytes);
    return true;
  }
  // told by the parser that comes after
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

 private:
  void refuse(const std::string& value) const {
    if (extras_ == 0)
      throw InputError(fmt::format("the integer {}, beyond every index and length that is read", value));
  }
  void take(std::size_t bytes) {
    // tinygltf copies these once more, each into an object of its own
    bytes_ += bytes + (copied_ > 0 ? sizeof(tinygltf::Value) : 0);
    if (bytes_ > kMaxGltfJsonMemory)
      throw InputError(
          fmt::format("its JSON would take more than {} bytes of memory, which is the limit: "
                      "too many objects ('{}' came last)",
                      kMaxGltfJsonMemory, shortened(array_)));
  }
  bool scalar() {
    if (extras_ == depth_ + 1) extras_ = 0;
    if (copied_ == depth_ + 1) copied_ = 0;
    take(kValueBytes);
    return true;
  }
  bool open(bool object) {
    if (object && depth_ == 2) take(objectBytes(array_));
    if (object && depth_ == 4 && array_ == "meshes") take(sizeof(tinygltf::Primitive));
    take(kContainerBytes);
    if (++depth_ > kMaxDepth)
      throw InputError(fmt::format("the JSON is nested more than {} deep", kMaxDepth));
    return true;
  }
  bool close() {
    --depth_;
    return scalar();
  }

  int depth_ = 0;
  int extras_ = 0;     // the depth within the outermost "extras", 0 outside
  int copied_ = 0;     // the same of the outermost "extras" or "extensions"
  std::string array_;  // the key of the file that this is below
  std::size_t bytes_ = 0;
};

}  // namespace

GltfJson parseGltfJson(std::string_view text) {
  if (text.size() > kMaxGltfJson)
    throw InputError(fmt::format("the JSON has {} bytes; up to {} are read", text.size(), kMaxGltfJson));
  // what some exporters pad the chunk of a GLB with
  while (!text.empty() && text.back() == '\0') text.remove_suffix(1);
  Limits limits;
  GltfJson::sax_parse(text, &limits);
  return parseJsonText(text);
}

}  // namespace ltcfit
