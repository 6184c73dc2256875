// What a person looking at scenes has changed about them: the state behind the window, without the window.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "render/lights.h"
#include "render/scene.h"

namespace ltcfit {

enum class ViewerAction {
  kRougher,
  kSmoother,
  kMoreAnisotropic,  ///< rougher along the tangent, smoother across; the other does the reverse
  kLessAnisotropic,
  kTurnLeft,
  kTurnRight,
  kLargerLights,
  kSmallerLights,
  kNextLight,  ///< as in the scene, quad, star, disk
  kNextScene,
  kPreviousScene,
  kReset,
};

/// Scenes, one of them shown, with changes that go along from scene to scene; the camera starts anew.
class Viewer {
 public:
  /// At least one scene; others are a caller's bug and abort. With `isotropic` the materials stay isotropic.
  Viewer(std::vector<Scene> scenes, bool isotropic);

  void apply(ViewerAction action);
  /// Turns the camera about its target: angles to the right and up, radians. It stops short of straight above
  /// and below.
  void orbit(double right, double up);
  /// Nearer by a tenth for each step; farther for negative ones.
  void zoom(double steps);

  /// What there is to draw, at the size of the picture.
  Scene scene(std::size_t width, std::size_t height) const;
  /// The scene's name and the values in force, on one line.
  std::string title() const;

 private:
  Material changed(Material material) const;
  PolygonLight changed(const PolygonLight& light) const;

  std::vector<Scene> scenes_;
  bool isotropic_;
  std::size_t shown_ = 0;
  int roughness_ = 0;   ///< steps
  int anisotropy_ = 0;  ///< steps
  int turn_ = 0;        ///< steps
  int size_ = 0;        ///< steps
  std::optional<LightShape> shape_;
  double right_ = 0.0;  ///< of the camera, radians
  double up_ = 0.0;
  double distance_ = 1.0;  ///< times the scene's
};

}  // namespace ltcfit
