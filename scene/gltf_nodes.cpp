#include "scene/gltf_nodes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

std::size_t checked(int index, std::size_t count, const char* what, const std::string& where) {
  if (index < 0 || static_cast<std::size_t>(index) >= count)
    throw InputError(fmt::format("{} names {} {} of {}", where, what, index, count));
  return static_cast<std::size_t>(index);
}

// The parent of each node, kNone at the roots.
std::vector<std::size_t> parentsOf(const std::vector<tinygltf::Node>& nodes) {
  std::vector<std::size_t> parents(nodes.size(), kNone);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const int child : nodes[i].children) {
      std::size_t& parent = parents[checked(child, nodes.size(), "node", fmt::format("node {}", i))];
      if (parent != kNone)
        throw InputError(fmt::format("node {} has two parents, {} and {}", child, parent, i));
      parent = i;
    }
  }
  // no node that is its own ancestor: of the walks up, each stops at what an earlier one has seen
  std::vector<std::size_t> walk(nodes.size(), kNone);
  for (std::size_t start = 0; start < nodes.size(); ++start) {
    std::size_t i = start;
    for (; i != kNone && walk[i] == kNone; i = parents[i]) walk[i] = start;
    if (i != kNone && walk[i] == start) throw InputError(fmt::format("node {} is its own ancestor", i));
  }
  return parents;
}

Vector3d vectorOf(const std::vector<double>& values, const Vector3d& otherwise, const char* what,
                  std::size_t node) {
  if (values.empty()) return otherwise;
  if (values.size() != 3)
    throw InputError(fmt::format("node {} has a {} of {} numbers", node, what, values.size()));
  return {values[0], values[1], values[2]};
}

// Translations do not change areas.
Matrix3d linearOf(const tinygltf::Node& node, std::size_t index) {
  if (!node.matrix.empty()) {
    const std::vector<double>& m = node.matrix;
    if (m.size() != 16) throw InputError(fmt::format("node {} has a matrix of {} numbers", index, m.size()));
    Matrix3d linear;
    linear << m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10];
    return linear;
  }
  const Vector3d scale = vectorOf(node.scale, Vector3d::Ones(), "scale", index);
  Matrix3d rotation = Matrix3d::Identity();
  if (!node.rotation.empty()) {
    const std::vector<double>& q = node.rotation;
    if (q.size() != 4) throw InputError(fmt::format("node {} has a rotation of {} numbers", index, q.size()));
    const Eigen::Quaterniond quaternion(q[3], q[0], q[1], q[2]);
    // zero means none to viewers
    if (quaternion.norm() > 0.0) rotation = quaternion.normalized().toRotationMatrix();
  }
  return rotation * scale.asDiagonal();
}

std::vector<std::size_t> rootsOf(const tinygltf::Model& model, const std::vector<std::size_t>& parents) {
  std::vector<std::size_t> roots;
  const auto add = [&](std::size_t scene) {
    for (const int node : model.scenes[scene].nodes)
      roots.push_back(checked(node, model.nodes.size(), "node", fmt::format("scene {}", scene)));
  };
  if (model.defaultScene >= 0) {
    add(checked(model.defaultScene, model.scenes.size(), "scene", "the file"));
  } else if (!model.scenes.empty()) {
    for (std::size_t i = 0; i < model.scenes.size(); ++i) add(i);
  } else {
    for (std::size_t i = 0; i < parents.size(); ++i)
      if (parents[i] == kNone) roots.push_back(i);
  }
  return roots;
}

}  // namespace

std::vector<std::vector<Matrix3d>> placementsOfMeshes(const GltfFile& file) {
  const tinygltf::Model& model = file.model;
  const std::vector<std::size_t> parents = parentsOf(model.nodes);
  std::vector<std::vector<Matrix3d>> placements(model.meshes.size());
  std::vector<bool> seen(model.nodes.size(), false);
  struct Visit {
    std::size_t node;
    Matrix3d parent;
  };
  std::vector<Visit> pending;
  for (const std::size_t root : rootsOf(model, parents)) {
    pending.push_back({root, Matrix3d::Identity()});
    while (!pending.empty()) {
      const Visit visit = pending.back();
      pending.pop_back();
      // in another scene already
      if (seen[visit.node]) continue;
      seen[visit.node] = true;
      const tinygltf::Node& node = model.nodes[visit.node];
      const Matrix3d linear = visit.parent * linearOf(node, visit.node);
      if (node.mesh >= 0)
        placements[checked(node.mesh, model.meshes.size(), "mesh", fmt::format("node {}", visit.node))]
            .push_back(linear);
      for (const int child : node.children) pending.push_back({static_cast<std::size_t>(child), linear});
    }
  }
  return placements;
}

}  // namespace ltcfit
