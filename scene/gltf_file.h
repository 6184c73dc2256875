// A glTF 2.0 file, opened: its JSON as tinygltf reads it, and its bytes.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ltcfit {

/// An image that the file names. Its bytes are read when asked for: most images of a scene are not needed
/// here.
struct GltfImage {
  std::string uri;  ///< of a file or with the data; empty: in a buffer view
  int bufferView = -1;
  std::string mimeType;  ///< empty where the file does not say
};

struct GltfFile {
  std::filesystem::path folder;  ///< of the file, to which its URIs are relative
  tinygltf::Model model;         ///< without images, skins, animations and cameras
  std::vector<GltfImage> images;
};

/// Largest glTF file, and sum of the buffers that it names.
inline constexpr std::size_t kMaxGltfBytes = std::size_t{1} << 30;
/// Largest JSON part: it is held several times while it is read.
inline constexpr std::size_t kMaxGltfJson = std::size_t{1} << 28;
/// Memory that its objects may take, by an estimate before any is kept: "{}," is three bytes of a file, and
/// more than 1,000 of a material.
inline constexpr std::size_t kMaxGltfJsonMemory = std::size_t{1} << 32;

/// The bytes are those of a .glb, whatever follows.
bool isGlb(std::string_view bytes);

/// Reads `bytes`, a .gltf or .glb that lies in `folder`, and the buffers it names. URIs are file names
/// relative to the folder, percent-encoded; ".." is followed, as viewers do, an absolute path or another
/// scheme than data: is not, nor is anything read that is no regular file. Buffer views lie within their
/// buffers in what comes back, and fields have the types and values that glTF has (gltf_types.h); nothing is
/// promised of indices. Compressed geometry stays unread: primitives
/// with KHR_draco_mesh_compression come without attributes, buffer views with EXT_meshopt_compression or
/// KHR_meshopt_compression point at nothing. InputError for anything that is not so.
GltfFile parseGltf(std::string_view bytes, const std::filesystem::path& folder);

/// The bytes of a buffer view; InputError if there is none of this number or it is compressed.
std::string_view viewBytes(const GltfFile& file, int view);

bool isMeshoptCompressed(const tinygltf::BufferView& view);

/// The bytes of an image; InputError if its file is missing, empty or too large or its data URI cannot be
/// decoded.
std::string imageBytes(const GltfFile& file, std::size_t image);

/// For messages: an image's URI, shortened, or its number.
std::string imageName(const GltfFile& file, std::size_t image);

}  // namespace ltcfit
