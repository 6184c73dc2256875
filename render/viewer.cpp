#include "render/viewer.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/diagnostics.h"

namespace ltcfit {
namespace {

constexpr double kMinAlpha = 1e-4;  // the floor of the tables
constexpr double kTurnStep = 5.0 * kRadiansPerDegree;
constexpr double kMaxPitch = 89.0 * kRadiansPerDegree;

// A step is a quarter octave of alpha, and of a light's size.
double octaves(int steps) {
  return std::exp2(0.25 * steps);
}

Eigen::Vector3d centreOf(const PolygonLight& light) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& v : light.vertices) sum += v;
  return sum / static_cast<double>(light.vertices.size());
}

// Half the cross products of its outline: along the normal, its length the area.
Eigen::Vector3d areaOf(const PolygonLight& light) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const std::vector<Eigen::Vector3d>& v = light.vertices;
  for (std::size_t i = 1; i + 1 < v.size(); ++i) sum += 0.5 * (v[i] - v[0]).cross(v[i + 1] - v[0]);
  return sum;
}

const char* nameOf(std::optional<LightShape> shape) {
  if (!shape) return "as in the scene";
  return *shape == LightShape::kQuad ? "quad" : *shape == LightShape::kStar ? "star" : "disk";
}

}  // namespace

Viewer::Viewer(std::vector<Scene> scenes, bool isotropic)
    : scenes_(std::move(scenes)), isotropic_(isotropic) {
  if (scenes_.empty()) abortWith("Viewer: no scenes");
}

void Viewer::apply(ViewerAction action) {
  const auto show = [&](std::size_t scene) {
    shown_ = scene % scenes_.size();
    right_ = up_ = 0.0;
    distance_ = 1.0;
  };
  switch (action) {
    case ViewerAction::kRougher:
      ++roughness_;
      break;
    case ViewerAction::kSmoother:
      --roughness_;
      break;
    case ViewerAction::kMoreAnisotropic:
      ++anisotropy_;
      break;
    case ViewerAction::kLessAnisotropic:
      --anisotropy_;
      break;
    case ViewerAction::kTurnLeft:
      ++turn_;
      break;
    case ViewerAction::kTurnRight:
      --turn_;
      break;
    case ViewerAction::kLargerLights:
      ++size_;
      break;
    case ViewerAction::kSmallerLights:
      --size_;
      break;
    case ViewerAction::kNextLight:
      if (!shape_) {
        shape_ = LightShape::kQuad;
      } else if (*shape_ == LightShape::kQuad) {
        shape_ = LightShape::kStar;
      } else if (*shape_ == LightShape::kStar) {
        shape_ = LightShape::kDisk;
      } else {
        shape_.reset();
      }
      break;
    case ViewerAction::kNextScene:
      show(shown_ + 1);
      break;
    case ViewerAction::kPreviousScene:
      show(shown_ + scenes_.size() - 1);
      break;
    case ViewerAction::kReset:
      roughness_ = anisotropy_ = turn_ = size_ = 0;
      shape_.reset();
      show(shown_);
      break;
  }
}

void Viewer::orbit(double right, double up) {
  right_ += right;
  up_ += up;
  const Camera& camera = scenes_[shown_].camera;
  const double above = std::asin(
      std::clamp((camera.position - camera.target).normalized().dot(camera.up.normalized()), -1.0, 1.0));
  up_ = std::clamp(up_, -kMaxPitch - above, kMaxPitch - above);
}

void Viewer::zoom(double steps) {
  distance_ = std::clamp(distance_ * std::pow(0.9, steps), 0.1, 10.0);
}

Material Viewer::changed(Material material) const {
  const int anisotropy = isotropic_ ? 0 : anisotropy_;
  const Eigen::Array2d factor(octaves(roughness_ + anisotropy), octaves(roughness_ - anisotropy));
  for (Eigen::Vector2d* alpha : {&material.alpha, &material.alphaEnd}) {
    if (alpha->x() > 0.0) *alpha = (alpha->array() * factor).max(kMinAlpha).min(1.0).matrix();
  }
  material.rotation += kTurnStep * turn_;
  return material;
}

PolygonLight Viewer::changed(const PolygonLight& light) const {
  PolygonLight out = light;
  const Eigen::Vector3d centre = centreOf(light);
  if (shape_) {
    const Eigen::Vector3d area = areaOf(light);
    const double half = 0.5 * std::sqrt(area.norm());
    out = makeLight(*shape_, centre, -area, Eigen::Vector2d(half, half));
    out.radiance = light.radiance;
    out.twoSided = light.twoSided;
  }
  for (Eigen::Vector3d& v : out.vertices) v = centre + octaves(size_) * (v - centre);
  return out;
}

Scene Viewer::scene(std::size_t width, std::size_t height) const {
  Scene scene = scenes_[shown_];
  for (Surface& s : scene.surfaces) s.material = changed(s.material);
  for (PolygonLight& l : scene.lights) l = changed(l);
  Camera& camera = scene.camera;
  camera.width = width;
  camera.height = height;
  const Eigen::Vector3d up = camera.up.normalized();
  Eigen::Vector3d from = camera.position - camera.target;
  const Eigen::Vector3d axis = up.cross(from);
  // the camera goes right, and up
  if (axis.norm() > 0.0) from = Eigen::AngleAxisd(-up_, axis.normalized()) * from;
  from = Eigen::AngleAxisd(right_, up) * from;
  camera.position = camera.target + distance_ * from;
  return scene;
}

std::string Viewer::title() const {
  const Material m = changed(scenes_[shown_].surfaces.at(0).material);
  const std::string alpha = isotropic_ ? fmt::format("{:.4f}", m.alpha.x())
                                       : fmt::format("{:.4f} x {:.4f}", m.alpha.x(), m.alpha.y());
  return fmt::format("{}: alpha {}, tangents {:.0f} degrees, lights {} x {:.2f}", scenes_[shown_].name, alpha,
                     m.rotation / kRadiansPerDegree, nameOf(shape_), octaves(size_));
}

}  // namespace ltcfit
