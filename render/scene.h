// Scenes of the shading check: a few surfaces under polygonal lights, without shadows and interreflections,
// which LTCs know nothing of. Every renderer here (GL, its double-precision twin, the Monte Carlo reference)
// draws the same Scene.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "render/film.h"

namespace ltcfit {

/// Largest numbers of a scene. They bound the GL shader's size, not its need of uniforms: all three at once,
/// with every texture, are 1372 components, while OpenGL 3.3 promises 1024 and OpenGL ES 3.0 896. GlRenderer
/// throws GlError where a context has fewer than a scene needs.
inline constexpr std::size_t kMaxSurfaces = 8;
inline constexpr std::size_t kMaxLights = 8;
inline constexpr std::size_t kMaxLightVertices = 24;

/// Pinhole camera: rays go through pixel centres. Row 0 is the top.
struct Camera {
  Eigen::Vector3d position = Eigen::Vector3d(0, -5, 2);
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double verticalFov = 0.7;  ///< radians
  std::size_t width = 160;
  std::size_t height = 120;
};

/// GGX with Schlick's Fresnel (F90 = 1) over a Lambertian base, which simply add up: both are grey.
struct Material {
  /// Roughness along the tangent and across it: GGX's alpha, in (0, 1]. On a rectangle with
  /// `alphaEnd` its root goes evenly from the one, at the tangent's begin, to the other at its end.
  Eigen::Vector2d alpha = Eigen::Vector2d(0.25, 0.25);
  Eigen::Vector2d alphaEnd = Eigen::Vector2d::Zero();  ///< zero: alpha everywhere
  double f0 = 1.0;                                     ///< reflectance at normal incidence, 0..1
  double diffuse = 0.0;                                ///< albedo of the base, 0..1
  double rotation = 0.0;                               ///< of the tangent about the normal, radians

  bool isRamp() const { return alphaEnd.x() > 0.0; }
  bool isIsotropic() const { return alpha.x() == alpha.y() && (!isRamp() || alphaEnd.x() == alphaEnd.y()); }
};

enum class SurfaceShape {
  kRectangle,  ///< one-sided: not there when seen from behind its normal, tangent x bitangent
  kSphere,     ///< tangents run around `axis`
};

struct Surface {
  SurfaceShape shape = SurfaceShape::kRectangle;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  // rectangle
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();    ///< unit
  Eigen::Vector3d bitangent = Eigen::Vector3d::UnitY();  ///< unit, perpendicular to the tangent
  Eigen::Vector2d halfSize = Eigen::Vector2d(4, 4);      ///< along both
  // sphere
  double radius = 1.0;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit

  Material material;
};

/// A plane polygon, convex or not. It emits to the side from which its vertices run clockwise: a light above
/// the ground whose vertices run counterclockwise seen from the sky lights the ground.
struct PolygonLight {
  std::vector<Eigen::Vector3d> vertices;  ///< world, 3..kMaxLightVertices
  Eigen::Vector3d radiance = Eigen::Vector3d::Ones();
  bool twoSided = false;
  /// Index of its texture among the scene's, which multiplies the radiance; -1: none. Rectangles only:
  /// texture coordinates (0, 0), (1, 0), (1, 1), (0, 1) at vertices 0 to 3; v = 0 is the picture's top row.
  int texture = -1;
};

/// Linear RGB, row by row from the top, texel centres at half-integers; read bilinearly, clamped to the edge.
struct LightTexture {
  std::string name;
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Eigen::Vector3d> texels;
};

/// The texture at u to the right and v down, both 0..1 within it.
Eigen::Vector3d textureAt(const LightTexture& texture, double u, double v);

struct Scene {
  std::string name;   ///< for files: lower case, digits, '-'
  std::string title;  ///< one line for people: what it shows
  Camera camera;
  std::vector<Surface> surfaces;
  std::vector<PolygonLight> lights;
  std::vector<LightTexture> textures;

  bool isIsotropic() const {
    for (const Surface& s : surfaces)
      if (!s.material.isIsotropic()) return false;
    return true;
  }
  /// Whether some f0 is below 1, so that tables without fresnel cannot shade it.
  bool needsFresnel() const {
    for (const Surface& s : surfaces)
      if (s.material.f0 < 1.0) return true;
    return false;
  }
};

/// Where the ray through the centre of a pixel first meets a surface.
struct SurfacePoint {
  const Surface* surface = nullptr;
  Eigen::Vector3d position;  ///< world
  /// World to shading frame: rows tangent (turned by the material's rotation), bitangent = n x tangent, n.
  Eigen::Matrix3d frame;
  Eigen::Vector3d wo;     ///< unit, in the shading frame; z >= 0
  Eigen::Vector2d alpha;  ///< of the material, here
};

/// What the pixel in `column` and `row` (from the top) shows; `point` is set for kSurface, `radiance`
/// for kLight. A light hides what is behind it, seen from either side.
struct PixelView {
  PixelKind kind = PixelKind::kBackground;
  SurfacePoint point;
  Eigen::Vector3d radiance = Eigen::Vector3d::Zero();
};
PixelView viewPixel(const Scene& scene, std::size_t column, std::size_t row);

/// Vertices of a light relative to a surface point, in its shading frame.
std::vector<Eigen::Vector3d> lightFrom(const SurfacePoint& point, const PolygonLight& light);

}  // namespace ltcfit
