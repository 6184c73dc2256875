// The scenes of the shading check.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/lights.h"
#include "render/scene.h"

namespace ltcfit {

/// A scene with what the check expects of it.
struct CheckScene {
  Scene scene;
  double psnrFloor = 50.0;  ///< GL against the twin, float tables, dB
  std::string loss;         ///< why it is not higher: one sentence
};

/// The scenes of the papers and the hard cases. `anisotropic`: those with brushed materials as well, which
/// need an anisotropic table.
std::vector<CheckScene> namedScenes(bool anisotropic);

/// One scene as asked for on the command line: a sphere and the ground of one material under one light.
struct CustomScene {
  LightShape light = LightShape::kQuad;
  Eigen::Vector2d alpha = Eigen::Vector2d(0.25, 0.25);  ///< in (0, 1]
  double angle = 0.0;                                   ///< of the tangents about the normal, radians
};
Scene makeScene(const CustomScene& custom);

/// Scene `index` of the random ones of a seed: a sphere on the ground under one rectangular light anywhere
/// above or through the horizon, size, tilt, view and material random; specular alone (f0 = 1), since that is
/// what a table decides. Isotropic ones have a roughness (the root of alpha) uniform in 0.05..1; anisotropic
/// ones alpha uniform in 0.03..1 and lambda in 0.05..1, either axis the rougher, tangents at any angle: the
/// off-grid distributions of the scores. `size`: pixels along each side.
Scene randomScene(std::uint64_t seed, std::uint64_t index, bool anisotropic, std::size_t size);

}  // namespace ltcfit
