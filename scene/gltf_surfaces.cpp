#include "scene/gltf_surfaces.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "export/atomic_file.h"
#include "scene/gltf_nodes.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Triangles trianglesOf(const std::vector<std::uint32_t>& vertices, int mode) {
  Triangles triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    for (std::size_t i = 0; i + 3 <= vertices.size(); i += 3)
      triangles.push_back({vertices[i], vertices[i + 1], vertices[i + 2]});
  } else {
    for (std::size_t i = 2; i < vertices.size(); ++i)
      triangles.push_back(
          {mode == TINYGLTF_MODE_TRIANGLE_FAN ? vertices[0] : vertices[i - 2], vertices[i - 1], vertices[i]});
  }
  return triangles;
}

bool hasTriangles(const tinygltf::Primitive& primitive) {
  return primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN;
}

bool isCompressed(const tinygltf::Primitive& primitive, const GltfAccessors& accessors,
                  const std::string& name) {
  if (primitive.extensions.contains("KHR_draco_mesh_compression")) return true;
  const auto position = primitive.attributes.find("POSITION");
  return (position != primitive.attributes.end() && !accessors.readable(position->second, name)) ||
         (primitive.indices >= 0 && !accessors.readable(primitive.indices, name));
}

void addAreas(GltfSurface& surface, const std::vector<float>& positions,
              const std::vector<Matrix3d>& placements) {
  const auto vertex = [&](std::uint32_t i) {
    const float* at = &positions[3 * std::size_t{i}];
    return Vector3d(at[0], at[1], at[2]);
  };
  surface.areas.reserve(surface.triangles.size());
  for (const auto& [a, b, c] : surface.triangles) {
    const Vector3d first = vertex(b) - vertex(a);
    const Vector3d second = vertex(c) - vertex(a);
    double area = 0.0;
    for (const Matrix3d& linear : placements) area += 0.5 * (linear * first).cross(linear * second).norm();
    if (!std::isfinite(area)) throw InputError(surface.name + ": a triangle whose area is not finite");
    surface.areas.push_back(area);
  }
  surface.area = std::accumulate(surface.areas.begin(), surface.areas.end(), 0.0);
}

// The materials of KHR_materials_variants, which a viewer may switch to.
void addVariants(const tinygltf::Primitive& primitive, std::vector<int>& materials) {
  const auto extension = primitive.extensions.find("KHR_materials_variants");
  if (extension == primitive.extensions.end() || !extension->second.Get("mappings").IsArray()) return;
  const tinygltf::Value& mappings = extension->second.Get("mappings");
  std::set<int> known(materials.begin(), materials.end());
  for (std::size_t i = 0; i < mappings.ArrayLen(); ++i) {
    const tinygltf::Value& mapping = mappings.Get(static_cast<int>(i));
    if (!mapping.IsObject() || !mapping.Get("material").IsInt()) continue;
    const int material = mapping.Get("material").GetNumberAsInt();
    if (known.insert(material).second) materials.push_back(material);
  }
}

std::string nameOf(std::size_t mesh, std::size_t primitive) {
  return fmt::format("mesh {}, primitive {}", mesh, primitive);
}

// Counts triangles by what accessors say that they have, before any is read: many primitives may share one.
void refuseTooMany(const tinygltf::Model& model, const GltfAccessors& accessors,
                   const std::vector<std::vector<Matrix3d>>& placements) {
  constexpr std::size_t kBytes = sizeof(Triangles::value_type) + sizeof(double);
  std::size_t placed = 0;
  std::size_t kept = 0;
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    if (placements[m].empty()) continue;
    for (std::size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
      const tinygltf::Primitive& primitive = model.meshes[m].primitives[p];
      const std::string name = nameOf(m, p);
      if (!hasTriangles(primitive) || isCompressed(primitive, accessors, name)) continue;
      const auto position = primitive.attributes.find("POSITION");
      if (position == primitive.attributes.end()) continue;
      const std::size_t vertices =
          accessors.count(primitive.indices >= 0 ? primitive.indices : position->second, name);
      const std::size_t triangles =
          primitive.mode == TINYGLTF_MODE_TRIANGLES ? vertices / 3 : std::max<std::size_t>(vertices, 2) - 2;
      if (triangles > (kMaxPlacedTriangles - placed) / placements[m].size())
        throw InputError(fmt::format("{}: more than {} triangles in all", name, kMaxPlacedTriangles));
      placed += triangles * placements[m].size();
      kept += triangles;
      if (kept * kBytes > kMaxTriangleBytes)
        throw InputError(
            fmt::format("{}: {} triangles so far would take {} bytes of memory; up to {} are "
                        "allowed: read parts of the scene one by one",
                        name, kept, kept * kBytes, kMaxTriangleBytes));
    }
  }
}

// Notes that a file needs but once.
struct Seen {
  bool lines = false;
  bool colours = false;
  bool variants = false;
  bool moving = false;
};

void addNotes(const Seen& seen, const GltfFile& file, std::vector<std::string>& notes) {
  if (seen.lines) notes.push_back("Points and lines have no area and are not counted.");
  if (seen.colours)
    notes.push_back("Vertex colours are not counted: metals are as bright as their base colour.");
  if (seen.variants)
    notes.push_back("The materials of all variants are counted, each with the whole area it may cover.");
  if (seen.moving) notes.push_back("Skinned and morphed meshes are counted at rest.");
  for (const tinygltf::Node& node : file.model.nodes) {
    if (!node.extensions.contains("EXT_mesh_gpu_instancing")) continue;
    notes.push_back("Instances of EXT_mesh_gpu_instancing are counted once.");
    break;
  }
}

}  // namespace

std::vector<GltfSurface> surfacesOf(const GltfFile& file, GltfAccessors& accessors,
                                    std::vector<std::string>& notes) {
  const tinygltf::Model& model = file.model;
  const std::vector<std::vector<Matrix3d>> placements = placementsOfMeshes(file);
  std::vector<GltfSurface> surfaces;
  Seen seen;
  refuseTooMany(model, accessors, placements);
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    if (placements[m].empty()) continue;
    for (std::size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
      const tinygltf::Primitive& primitive = model.meshes[m].primitives[p];
      if (!hasTriangles(primitive)) {
        seen.lines = true;
        continue;
      }
      GltfSurface surface;
      surface.name = nameOf(m, p);
      surface.primitive = &primitive;
      surface.materials = {primitive.material};
      addVariants(primitive, surface.materials);
      for (const int material : surface.materials)
        if (material < -1 || material >= static_cast<int>(model.materials.size()))
          throw InputError(
              fmt::format("{} names material {} of {}", surface.name, material, model.materials.size()));
      seen.variants = seen.variants || surface.materials.size() > 1;
      seen.colours = seen.colours || primitive.attributes.contains("COLOR_0");
      seen.moving = seen.moving || !primitive.targets.empty() || primitive.attributes.contains("JOINTS_0");
      surface.compressed = isCompressed(primitive, accessors, surface.name);
      const auto position = primitive.attributes.find("POSITION");
      if (!surface.compressed && position != primitive.attributes.end()) {
        const std::vector<float> positions = accessors.vectors(position->second, 3, surface.name);
        const std::size_t count = positions.size() / 3;
        std::vector<std::uint32_t> vertices;
        if (primitive.indices >= 0) {
          vertices = accessors.indices(primitive.indices, surface.name);
        } else {
          vertices.resize(count);
          std::iota(vertices.begin(), vertices.end(), 0u);
        }
        for (const std::uint32_t vertex : vertices)
          if (vertex >= count)
            throw InputError(fmt::format("{} names vertex {} of {}", surface.name, vertex, count));
        surface.triangles = trianglesOf(vertices, primitive.mode);
        addAreas(surface, positions, placements[m]);
      }
      surfaces.push_back(std::move(surface));
    }
  }
  addNotes(seen, file, notes);
  return surfaces;
}

}  // namespace ltcfit
