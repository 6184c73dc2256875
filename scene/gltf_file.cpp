#include "scene/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "export/atomic_file.h"
#include "scene/gltf_json.h"
#include "scene/gltf_types.h"
#include "scene/gltf_uri.h"
#include "scene/texel_image.h"

namespace ltcfit {
namespace {

constexpr std::string_view kBufferName = "buffer-";
constexpr std::string_view kEmptyBuffer = "data:application/octet-stream;base64,AA==";

struct Chunks {
  std::string_view json;
  std::string_view binary;
};

std::uint32_t littleEndian32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

// tinygltf's own walk over the chunks reads up to 8 bytes beyond the file when the last is cut off.
Chunks chunksOfGlb(std::string_view bytes) {
  constexpr std::size_t kHeader = 12;
  constexpr std::size_t kChunkHeader = 8;
  constexpr std::uint32_t kJson = 0x4e4f534a;
  constexpr std::uint32_t kBinary = 0x004e4942;
  if (bytes.size() < kHeader) throw InputError("the GLB header is cut off");
  const std::uint32_t version = littleEndian32(bytes, 4);
  if (version != 2) throw InputError(fmt::format("version {} of the GLB container; 2 is read", version));
  const std::size_t length = littleEndian32(bytes, 8);
  if (length > bytes.size())
    throw InputError(
        fmt::format("the GLB says that it has {} bytes and has {}: cut off?", length, bytes.size()));
  Chunks chunks;
  for (std::size_t at = kHeader; at < length;) {
    if (length - at < kChunkHeader) throw InputError(fmt::format("the GLB chunk at byte {} is cut off", at));
    const std::size_t size = littleEndian32(bytes, at);
    const std::uint32_t kind = littleEndian32(bytes, at + 4);
    if (size > length - at - kChunkHeader)
      throw InputError(
          fmt::format("the GLB chunk at byte {} has {} bytes, which the file has not", at, size));
    const std::string_view content = bytes.substr(at + kChunkHeader, size);
    if (at == kHeader && kind != kJson) throw InputError("the first GLB chunk is not JSON");
    if (at == kHeader) chunks.json = content;
    if (kind == kBinary && chunks.binary.empty()) chunks.binary = content;
    at += kChunkHeader + size;
  }
  if (chunks.json.empty()) throw InputError("the GLB has no JSON chunk");
  return chunks;
}

// Says what a file is that is neither a GLB nor an object of JSON.
void refuseOtherFiles(std::string_view bytes) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  if (start != std::string_view::npos && bytes[start] == '{') return;
  std::string kind = unreadableKind(bytes);
  if (bytes.starts_with("\x89PNG")) kind.assign("PNG");
  if (bytes.starts_with("\xff\xd8\xff")) kind.assign("JPEG");
  throw InputError(fmt::format("{}neither glTF nor a scene description",
                               kind.empty() ? std::string() : fmt::format("a picture ({}), ", kind)));
}

GltfJson& arrayOf(GltfJson& json, const char* key) {
  GltfJson& value = json[key];
  if (value.is_null()) value = GltfJson::array();
  if (!value.is_array()) throw InputError(fmt::format("'{}' is not an array", key));
  return value;
}

std::string textOf(const GltfJson& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) return {};
  if (!found->is_string()) throw InputError(fmt::format("'{}' is not a string", key));
  return found->get<std::string>();
}

bool hasExtension(const GltfJson& object, const char* name) {
  const auto extensions = object.find("extensions");
  return extensions != object.end() && extensions->is_object() && extensions->contains(name);
}

// What tinygltf is given in place of files.
using Buffers = std::map<std::string, std::string>;

// Takes the buffers that are not data URIs out of the JSON into `buffers`.
void resolveBuffers(GltfJson& json, std::string_view binary, const std::filesystem::path& folder,
                    Buffers& buffers) {
  std::size_t total = 0;
  std::size_t i = 0;
  for (GltfJson& buffer : arrayOf(json, "buffers")) {
    const std::string name = fmt::format("{}{}", kBufferName, i);
    if (!buffer.is_object()) throw InputError(name + " is not an object");
    const auto lengthField = buffer.find("byteLength");
    if (lengthField == buffer.end() || !lengthField->is_number_unsigned())
      throw InputError(name + " has no byteLength");
    const std::size_t length = lengthField->get<std::size_t>();
    total += length;
    if (total > kMaxGltfBytes)
      throw InputError(fmt::format("its buffers have more than {} bytes", kMaxGltfBytes));
    const std::string uri = textOf(buffer, "uri");
    const auto take = [&](std::string_view bytes, const std::string& what) {
      if (bytes.size() < length)
        throw InputError(
            fmt::format("{} says that it has {} bytes, {} has {}", name, length, what, bytes.size()));
      buffers[name] = bytes.substr(0, length);
      buffer["uri"] = name;
    };
    if (uri.empty() && (hasExtension(buffer, "EXT_meshopt_compression") ||
                        hasExtension(buffer, "KHR_meshopt_compression"))) {
      buffer = {{"byteLength", 1}, {"uri", kEmptyBuffer}};
    } else if (uri.empty()) {
      if (i > 0 || binary.empty()) throw InputError(name + " has neither a URI nor a chunk of the file");
      take(binary, "the GLB chunk");
    } else if (!isDataUri(uri)) {
      take(readRelative(folder, uri), shortened(uri));
    } else if (!tinygltf::IsDataURI(uri)) {
      throw InputError(fmt::format("{} has a data URI of an unknown kind ({})", name, shortened(uri)));
    } else if (uri.size() / 4 * 3 + 3 < length) {
      throw InputError(fmt::format("{} says that it has {} bytes, its data URI has fewer", name, length));
    }
    ++i;
  }
}

// tinygltf insists on index data that a Draco primitive need not have, and drops one without attributes.
void withoutDraco(GltfJson& json) {
  for (GltfJson& mesh : arrayOf(json, "meshes")) {
    for (GltfJson& primitive : arrayOf(mesh, "primitives")) {
      if (!hasExtension(primitive, "KHR_draco_mesh_compression")) continue;
      primitive.erase("indices");
      primitive["attributes"] = GltfJson::object();
    }
  }
}

std::vector<GltfImage> imagesOf(GltfJson& json) {
  std::vector<GltfImage> images;
  for (const GltfJson& image : arrayOf(json, "images")) {
    GltfImage out;
    out.uri = textOf(image, "uri");
    out.mimeType = textOf(image, "mimeType");
    if (const auto view = image.find("bufferView"); view != image.end()) out.bufferView = view->get<int>();
    images.push_back(std::move(out));
  }
  return images;
}

// tinygltf sees no file: only what `userData` holds.
tinygltf::FsCallbacks callbacks(Buffers& buffers) {
  tinygltf::FsCallbacks fs{};
  fs.FileExists = [](const std::string& name, void* data) {
    return static_cast<Buffers*>(data)->contains(name);
  };
  fs.ExpandFilePath = [](const std::string& name, void*) { return name; };
  fs.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string& name, void* data) {
    const std::string& bytes = static_cast<Buffers*>(data)->at(name);
    out->assign(bytes.begin(), bytes.end());
    return true;
  };
  fs.user_data = &buffers;
  return fs;
}

void checkViews(const tinygltf::Model& model) {
  for (std::size_t i = 0; i < model.bufferViews.size(); ++i) {
    const tinygltf::BufferView& view = model.bufferViews[i];
    if (isMeshoptCompressed(view)) continue;
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
      throw InputError(
          fmt::format("buffer view {} names buffer {} of {}", i, view.buffer, model.buffers.size()));
    const std::size_t size = model.buffers[static_cast<std::size_t>(view.buffer)].data.size();
    if (view.byteOffset > size || view.byteLength > size - view.byteOffset)
      throw InputError(fmt::format("buffer view {} has {} bytes from {} on; buffer {} has {}", i,
                                   view.byteLength, view.byteOffset, view.buffer, size));
  }
}

}  // namespace

bool isGlb(std::string_view bytes) {
  return bytes.starts_with("glTF");
}

bool isMeshoptCompressed(const tinygltf::BufferView& view) {
  return view.extensions.contains("EXT_meshopt_compression") ||
         view.extensions.contains("KHR_meshopt_compression");
}

GltfFile parseGltf(std::string_view bytes, const std::filesystem::path& folder) {
  const Chunks chunks = isGlb(bytes) ? chunksOfGlb(bytes) : Chunks{bytes, {}};
  if (!isGlb(bytes)) refuseOtherFiles(bytes);
  GltfJson all = parseGltfJson(chunks.json);
  if (!all.is_object() || !all.contains("asset") || !all["asset"].is_object())
    throw InputError("neither glTF (no 'asset') nor a scene description (no \"format\": \"ltc-scene\")");
  const std::string version = textOf(all["asset"], "version");
  if (!version.starts_with("2.")) throw InputError(fmt::format("glTF version '{}'; 2.0 is read", version));
  checkGltfTypes(all);
  // the rest is not looked at, and tinygltf need not either
  GltfJson json{{"asset", {{"version", "2.0"}}}};
  for (const char* key : {"scene", "scenes", "nodes", "meshes", "materials", "textures", "samplers",
                          "accessors", "bufferViews", "buffers", "extensionsUsed", "extensionsRequired"})
    if (all.contains(key)) json[key] = std::move(all[key]);
  GltfFile file;
  file.folder = folder;
  file.images = imagesOf(all);
  Buffers buffers;
  resolveBuffers(json, chunks.binary, folder, buffers);
  withoutDraco(json);
  all = nullptr;

  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(callbacks(buffers));
  std::string error;
  std::string warning;
  const std::string text = json.dump();
  json = nullptr;
  bool loaded = false;
  try {
    loaded = loader.LoadASCIIFromString(&file.model, &error, &warning, text.data(),
                                        static_cast<unsigned>(text.size()), "");
  } catch (const std::exception& thrown) {
    error = thrown.what();
  }
  // it may complain and go on, without what it complains about
  if (!loaded || !error.empty()) throw InputError("no glTF: " + shortened(error.substr(0, error.find('\n'))));
  checkViews(file.model);
  return file;
}

std::string_view viewBytes(const GltfFile& file, int index) {
  const auto& views = file.model.bufferViews;
  if (index < 0 || static_cast<std::size_t>(index) >= views.size())
    throw InputError(fmt::format("buffer view {} of {}", index, views.size()));
  const tinygltf::BufferView& view = views[static_cast<std::size_t>(index)];
  if (isMeshoptCompressed(view)) throw InputError(fmt::format("buffer view {} is compressed", index));
  const auto& data = file.model.buffers[static_cast<std::size_t>(view.buffer)].data;
  return {reinterpret_cast<const char*>(data.data()) + view.byteOffset, view.byteLength};
}

std::string imageName(const GltfFile& file, std::size_t image) {
  const std::string& uri = file.images[image].uri;
  return uri.empty() || isDataUri(uri) ? fmt::format("image {}", image) : shortened(uri);
}

std::string imageBytes(const GltfFile& file, std::size_t index) {
  const GltfImage& image = file.images[index];
  if (image.uri.empty()) return std::string(viewBytes(file, image.bufferView));
  if (!isDataUri(image.uri)) return readRelative(file.folder, image.uri);
  return dataOfUri(image.uri, imageName(file, index));
}

}  // namespace ltcfit
