// Where the nodes of a glTF scene place meshes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene/gltf_file.h"

namespace ltcfit {

/// For every mesh the linear parts of its placements, in the order of surfacesOf, whose header says which
/// nodes count and which errors there are.
std::vector<std::vector<Eigen::Matrix3d>> placementsOfMeshes(const GltfFile& file);

}  // namespace ltcfit
