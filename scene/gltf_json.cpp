#include "scene/gltf_json.h"

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <string>

#include "export/atomic_file.h"
#include "scene/gltf_file.h"
#include "scene/json_text.h"

namespace ltcfit {
namespace {


// No file of Khronos reaches 16.
constexpr int kMaxDepth = 64;

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
  bool start_object(std::size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    if (extras_ == 0 && name == "extras") extras_ = depth_ + 1;
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
  bool scalar() {
    if (extras_ == depth_ + 1) extras_ = 0;
    return true;
  }
  bool open() {
    if (++depth_ > kMaxDepth)
      throw InputError(fmt::format("the JSON is nested more than {} deep", kMaxDepth));
    return true;
  }
  bool close() {
    --depth_;
    return scalar();
  }

  int depth_ = 0;
  int extras_ = 0;  // the depth within the outermost "extras", 0 outside
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
