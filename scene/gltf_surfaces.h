// The triangles that a glTF scene shows, and how large they are.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/gltf_accessor.h"
#include "scene/gltf_file.h"

namespace ltcfit {

/// One primitive of a mesh, wherever nodes place it.
struct GltfSurface {
  std::string name;            ///< for messages: "mesh 0, primitive 1"
  std::vector<int> materials;  ///< the one it has, then those of its variants; -1: the default material
  const tinygltf::Primitive* primitive = nullptr;
  bool compressed = false;                              ///< in a way that is not read: without triangles
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertices
  std::vector<double> areas;  ///< of each triangle in world space, all placements together
  double area = 0.0;          ///< their sum
};

/// Triangles times placements that one file may have.
inline constexpr std::size_t kMaxPlacedTriangles = std::size_t{1} << 28;
/// Memory that the triangles of one file may take: more than those of a file without shared accessors do.
inline constexpr std::size_t kMaxTriangleBytes = std::size_t{1} << 31;

/// What the default scene shows, or where none is the default all scenes, each node once; where there is no
/// scene at all, every node that has no parent. In order of meshes and primitives; without points and lines.
/// Skins and morph targets count at rest. `notes` gets a sentence on what is not as a viewer would show it.
/// InputError for indices out of range, a node with two parents or that is its own ancestor, transforms of a
/// wrong size, coordinates that are not finite, and, before any is read, more than kMaxPlacedTriangles or
/// kMaxTriangleBytes.
std::vector<GltfSurface> surfacesOf(const GltfFile& file, GltfAccessors& accessors,
                                    std::vector<std::string>& notes);

}  // namespace ltcfit
