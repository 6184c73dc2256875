// Makes glTF files for tests.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/texel_image.h"

namespace ltcfit::test {

using GltfJson = nlohmann::json;
using Numbers = std::vector<float>;

/// A PNG of RGBA texels.
std::string pngOf(const TexelImage& image);
/// An image whose texels are `texel(x, y)`.
template <typename Texel>
TexelImage imageOf(std::size_t width, std::size_t height, const Texel& texel) {
  TexelImage image;
  image.width = width;
  image.height = height;
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) image.texels.push_back(texel(x, y));
  return image;
}

std::string base64(const std::string& bytes);

/// A file with one scene; everything may be changed through `json` before it is written.
class GltfBuilder {
 public:
  GltfBuilder();

  int view(const std::string& bytes);
  template <typename T>
  int accessor(const char* type, int componentType, const std::vector<T>& numbers, std::size_t components) {
    std::string bytes(numbers.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    GltfJson accessor{{"bufferView", view(bytes)},
                      {"componentType", componentType},
                      {"count", numbers.size() / components},
                      {"type", type}};
    return push("accessors", accessor);
  }
  int vec3(const Numbers& numbers) { return accessor("VEC3", 5126, numbers, 3); }
  int vec2(const Numbers& numbers) { return accessor("VEC2", 5126, numbers, 2); }
  int indices(const std::vector<std::uint16_t>& numbers) { return accessor("SCALAR", 5123, numbers, 1); }
  int material(const GltfJson& material) { return push("materials", material); }
  /// A texture of an embedded PNG.
  int texture(const TexelImage& image, const GltfJson& sampler = nullptr);
  /// A mesh of one primitive.
  int mesh(const GltfJson& primitive) { return push("meshes", {{"primitives", {primitive}}}); }
  /// A node of the scene.
  int node(const GltfJson& node);
  /// The unit square with texture coordinates u0, v0 to u1, v1, in a mesh and node of its own.
  void quad(int material, const std::array<float, 4>& uv = {0.0f, 0.0f, 1.0f, 1.0f});
  int push(const char* key, const GltfJson& value);

  std::string glb() const;
  /// As text, with the buffer as a data URI.
  std::string gltf() const;

  GltfJson json;
  std::string data;
};

}  // namespace ltcfit::test
