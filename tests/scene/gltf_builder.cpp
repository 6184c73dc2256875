#include "tests/scene/gltf_builder.h"

#include <png.h>

#include <stdexcept>

namespace ltcfit::test {
namespace {

std::string littleEndian32(std::size_t value) {
  std::string out;
  for (int i = 0; i < 4; ++i) out += static_cast<char>(value >> (8 * i) & 255);
  return out;
}

std::string padded(std::string bytes, char with) {
  while (bytes.size() % 4 != 0) bytes += with;
  return bytes;
}

}  // namespace

std::string pngOf(const TexelImage& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = 0;
  if (png_image_write_get_memory_size(header, size, 0, image.texels.data(), 0, nullptr) == 0)
    throw std::runtime_error(header.message);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.texels.data(), 0, nullptr) == 0)
    throw std::runtime_error(header.message);
  bytes.resize(size);
  return bytes;
}

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
  }
  return out;
}

GltfBuilder::GltfBuilder() {
  json = {{"asset", {{"version", "2.0"}}},
          {"scene", 0},
          {"scenes", GltfJson::array({{{"nodes", GltfJson::array()}}})}};
}

int GltfBuilder::push(const char* key, const GltfJson& value) {
  GltfJson& array = json[key];
  array.push_back(value);
  return static_cast<int>(array.size()) - 1;
}

int GltfBuilder::view(const std::string& bytes) {
  data = padded(data, '\0');
  const int index =
      push("bufferViews", {{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", bytes.size()}});
  data += bytes;
  return index;
}

int GltfBuilder::texture(const TexelImage& image, const GltfJson& sampler) {
  const int bytes = view(pngOf(image));
  GltfJson texture{{"source", push("images", {{"bufferView", bytes}, {"mimeType", "image/png"}})}};
  if (!sampler.is_null()) texture["sampler"] = push("samplers", sampler);
  return push("textures", texture);
}

int GltfBuilder::node(const GltfJson& node) {
  const int index = push("nodes", node);
  json["scenes"][0]["nodes"].push_back(index);
  return index;
}

void GltfBuilder::quad(int material, const std::array<float, 4>& uv) {
  const auto& [u0, v0, u1, v1] = uv;
  node({{"mesh", mesh({{"attributes",
                        {{"POSITION", vec3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})},
                         {"TEXCOORD_0", vec2({u0, v0, u1, v0, u1, v1, u0, v1})}}},
                       {"indices", indices({0, 1, 2, 0, 2, 3})},
                       {"material", material}})}});
}

std::string GltfBuilder::glb() const {
  GltfJson all = json;
  const std::string binary = padded(data, '\0');
  if (!data.empty()) all["buffers"] = GltfJson::array({{{"byteLength", data.size()}}});
  const std::string text = padded(all.dump(), ' ');
  std::string body = littleEndian32(text.size()) + "JSON" + text;
  if (!data.empty()) body += littleEndian32(binary.size()) + std::string("BIN\0", 4) + binary;
  return "glTF" + littleEndian32(2) + littleEndian32(12 + body.size()) + body;
}

std::string GltfBuilder::gltf() const {
  GltfJson all = json;
  if (!data.empty())
    all["buffers"] = GltfJson::array(
        {{{"byteLength", data.size()}, {"uri", "data:application/octet-stream;base64," + base64(data)}}});
  return all.dump();
}

}  // namespace ltcfit::test
