#include "render/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/light_plane.h"

namespace ltcfit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  // unit
};

Ray pixelRay(const Camera& camera, std::size_t column, std::size_t row) {
  const Eigen::Vector3d forward = (camera.target - camera.position).normalized();
  const Eigen::Vector3d right = forward.cross(camera.up).normalized();
  const Eigen::Vector3d up = right.cross(forward);
  const double width = static_cast<double>(camera.width);
  const double height = static_cast<double>(camera.height);
  const double half = std::tan(0.5 * camera.verticalFov);
  const double x = (2.0 * (static_cast<double>(column) + 0.5) / width - 1.0) * half * width / height;
  const double y = (1.0 - 2.0 * (static_cast<double>(row) + 0.5) / height) * half;
  return {camera.position, (forward + x * right + y * up).normalized()};
}

// Distance along the ray, infinite where it misses.
double hitRectangle(const Surface& s, const Ray& ray) {
  const Eigen::Vector3d normal = s.tangent.cross(s.bitangent);
  const double towards = ray.direction.dot(normal);
  if (!(towards < 0.0)) return kInfinity;
  const double t = (s.centre - ray.origin).dot(normal) / towards;
  if (!(t > 0.0)) return kInfinity;
  const Eigen::Vector3d from = ray.origin + t * ray.direction - s.centre;
  return std::abs(from.dot(s.tangent)) <= s.halfSize.x() && std::abs(from.dot(s.bitangent)) <= s.halfSize.y()
             ? t
             : kInfinity;
}

double hitSphere(const Surface& s, const Ray& ray) {
  const Eigen::Vector3d from = ray.origin - s.centre;
  const double b = from.dot(ray.direction);
  // squared distance of the centre from the ray, without cancellation
  const double apart = (from - b * ray.direction).squaredNorm();
  const double under = s.radius * s.radius - apart;
  if (!(under > 0.0)) return kInfinity;
  const double t = -b - std::sqrt(under);
  return t > 0.0 ? t : kInfinity;
}

double hitLight(const PolygonLight& light, const Ray& ray) {
  const std::vector<Eigen::Vector3d>& v = light.vertices;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // its length is twice the area
  for (std::size_t i = 0; i < v.size(); ++i) normal += (v[i] - v[0]).cross(v[(i + 1) % v.size()] - v[0]);
  const double towards = ray.direction.dot(normal);
  if (towards == 0.0) return kInfinity;
  const double t = (v[0] - ray.origin).dot(normal) / towards;
  if (!(t > 0.0)) return kInfinity;
  const Eigen::Vector3d p = ray.origin + t * ray.direction;
  // crossings of the outline by a half-line, in the projection along the normal's largest component
  Eigen::Index drop = 0;
  normal.cwiseAbs().maxCoeff(&drop);
  const Eigen::Index a = (drop + 1) % 3;
  const Eigen::Index b = (drop + 2) % 3;
  const auto flat = [&](const Eigen::Vector3d& q) { return Eigen::Vector2d(q[a], q[b]); };
  bool inside = false;
  for (std::size_t i = 0; i < v.size(); ++i)
    inside ^= crossesEdge(flat(v[i]), flat(v[(i + 1) % v.size()]), flat(p));
  return inside ? t : kInfinity;
}

Eigen::Vector2d alphaAt(const Surface& s, const Eigen::Vector3d& position) {
  const Material& m = s.material;
  if (!m.isRamp()) return m.alpha;
  const double along = 0.5 + 0.5 * (position - s.centre).dot(s.tangent) / s.halfSize.x();
  const Eigen::Array2d root = (1.0 - along) * m.alpha.array().sqrt() + along * m.alphaEnd.array().sqrt();
  return root.square().matrix();
}

SurfacePoint surfacePoint(const Surface& s, const Eigen::Vector3d& position,
                          const Eigen::Vector3d& direction) {
  Eigen::Vector3d n;
  Eigen::Vector3d t;
  if (s.shape == SurfaceShape::kRectangle) {
    n = s.tangent.cross(s.bitangent);
    t = s.tangent;
  } else {
    n = (position - s.centre) / s.radius;
    t = s.axis.cross(n);
    // at the poles every direction goes around the axis
    t = t.squaredNorm() > 1e-20 ? t.normalized() : n.unitOrthogonal();
  }
  const Eigen::Vector3d b = n.cross(t);
  const double c = std::cos(s.material.rotation);
  const double sine = std::sin(s.material.rotation);
  SurfacePoint point;
  point.surface = &s;
  point.position = position;
  point.frame.row(0) = c * t + sine * b;
  point.frame.row(1) = c * b - sine * t;
  point.frame.row(2) = n;
  point.wo = (point.frame * -direction).normalized();
  point.wo.z() = std::max(point.wo.z(), 0.0);
  point.alpha = alphaAt(s, position);
  return point;
}

// Of the light seen directly at a point of its plane.
Eigen::Vector3d radianceAt(const Scene& scene, const PolygonLight& light, const Eigen::Vector3d& position) {
  if (light.texture < 0) return light.radiance;
  const Eigen::Vector3d from = position - light.vertices[0];
  const Eigen::Vector3d right = light.vertices[1] - light.vertices[0];
  const Eigen::Vector3d down = light.vertices[3] - light.vertices[0];
  return light.radiance.cwiseProduct(textureAt(scene.textures[static_cast<std::size_t>(light.texture)],
                                               from.dot(right) / right.squaredNorm(),
                                               from.dot(down) / down.squaredNorm()));
}

}  // namespace

Eigen::Vector3d textureAt(const LightTexture& texture, double s, double t) {
  const double w = static_cast<double>(texture.width);
  const double h = static_cast<double>(texture.height);
  const double x = std::clamp(s * w - 0.5, 0.0, w - 1.0);
  const double y = std::clamp(t * h - 0.5, 0.0, h - 1.0);
  const std::size_t x0 = static_cast<std::size_t>(x);
  const std::size_t y0 = static_cast<std::size_t>(y);
  const std::size_t x1 = std::min(x0 + 1, texture.width - 1);
  const std::size_t y1 = std::min(y0 + 1, texture.height - 1);
  const double a = x - static_cast<double>(x0);
  const double b = y - static_cast<double>(y0);
  const auto at = [&](std::size_t i, std::size_t j) { return texture.texels[j * texture.width + i]; };
  return (1.0 - b) * ((1.0 - a) * at(x0, y0) + a * at(x1, y0)) +
         b * ((1.0 - a) * at(x0, y1) + a * at(x1, y1));
}

PixelView viewPixel(const Scene& scene, std::size_t column, std::size_t row) {
  const Ray ray = pixelRay(scene.camera, column, row);
  PixelView view;
  double nearest = kInfinity;
  const Surface* hit = nullptr;
  for (const Surface& s : scene.surfaces) {
    const double t = s.shape == SurfaceShape::kRectangle ? hitRectangle(s, ray) : hitSphere(s, ray);
    if (t < nearest) {
      nearest = t;
      hit = &s;
    }
  }
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const double t = hitLight(scene.lights[i], ray);
    if (t < nearest) {
      nearest = t;
      view.kind = PixelKind::kLight;
      view.radiance = radianceAt(scene, scene.lights[i], ray.origin + t * ray.direction);
    }
  }
  if (hit != nullptr && view.kind != PixelKind::kLight) {
    view.kind = PixelKind::kSurface;
    view.point = surfacePoint(*hit, ray.origin + nearest * ray.direction, ray.direction);
  }
  return view;
}

std::vector<Eigen::Vector3d> lightFrom(const SurfacePoint& point, const PolygonLight& light) {
  std::vector<Eigen::Vector3d> out;
  out.reserve(light.vertices.size());
  for (const Eigen::Vector3d& v : light.vertices) out.push_back(point.frame * (v - point.position));
  return out;
}

}  // namespace ltcfit
