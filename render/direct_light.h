// Monte Carlo estimates of the light that one surface point sends to the camera.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ggx/ggx_lobe.h"
#include "render/light_plane.h"
#include "render/reference.h"
#include "render/scene.h"
#include "render/sobol.h"
#include "render/solid_angle_sampler.h"

namespace ltcfit {

/// Prepared for one point and the lights that it sees. Keeps references to all it is given.
class DirectLight {
 public:
  /// `planes` are those of the scene's lights.
  DirectLight(const Scene& scene, std::span<const LightPlane> planes, ReferenceSampling sampling)
      : scene_(scene), planes_(planes), sampling_(sampling) {}

  void setPoint(const SurfacePoint& point);

  /// Whether any light shines on the point; without, there is nothing to sample.
  bool isLit() const { return count_ > 0; }

  /// Sum of the estimates of samples `first` to `first + count` of the randomisation with that seed: linear
  /// RGB, to be divided by the number of samples. Each is bounded by the lights' radiance where the diffuse
  /// base is black.
  Eigen::Vector3d sum(std::uint64_t seed, std::uint32_t first, std::uint32_t count) const;

 private:
  struct SeenLight {
    std::size_t index;
    Eigen::Vector3d x, y, normal;  // of its plane, in the shading frame
    Eigen::Vector2d foot;          // the point's projection on its plane
    double height;                 // of its plane over the point, along the normal
    bool alone;                    // sampled without the lobe's help
    SolidAngleSampler sampler;

    // Where in its plane a direction meets it; only for directions towards it.
    Eigen::Vector2d place(const Eigen::Vector3d& wi) const {
      const double t = height / wi.dot(normal);
      return {foot.x() + t * wi.dot(x), foot.y() + t * wi.dot(y)};
    }
  };

  double fresnel(const Eigen::Vector3d& wi) const;
  Eigen::Vector3d emitted(const SeenLight& light, const Eigen::Vector2d& place) const;
  Eigen::Vector3d sumOverLight(const SeenLight& light, std::uint64_t seed, std::uint32_t first,
                               std::uint32_t count) const;
  Eigen::Vector3d sumOverLobe(std::uint64_t seed, std::uint32_t first, std::uint32_t count) const;

  const Scene& scene_;
  std::span<const LightPlane> planes_;
  ReferenceSampling sampling_;
  GgxLobe lobe_{Eigen::Vector3d::UnitZ(), {1.0, 1.0}};
  double f0_ = 1.0;
  double diffuse_ = 0.0;
  bool needsLobe_ = false;
  std::size_t count_ = 0;
  std::vector<SeenLight> seen_;  // the first count_ of them
  std::vector<Eigen::Vector3d> vertices_;
};

}  // namespace ltcfit
