#include "render/twin.h"

#include <fmt/format.h>
#include <omp.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ltc/polygon.h"
#include "ltc/sphere.h"

namespace ltcfit {
namespace {

// The frame of an isotropic table has the view in its x-z plane: turns vertices of the point's frame into it.
Eigen::Matrix3d towardsView(const Eigen::Vector3d& wo) {
  const double length = std::hypot(wo.x(), wo.y());
  if (length == 0.0) return Eigen::Matrix3d::Identity();
  const double c = wo.x() / length;
  const double s = wo.y() / length;
  Eigen::Matrix3d turn;
  turn << c, s, 0, -s, c, 0, 0, 0, 1;
  return turn;
}

// Turns the outline of a two-sided light seen from behind; false for a one-sided one.
bool turnToFront(const PolygonLight& light, std::vector<Eigen::Vector3d>& vertices) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i)
    normal += (vertices[i] - vertices[0]).cross(vertices[i + 1] - vertices[0]);
  if (normal.dot(vertices[0]) > 0.0) return true;
  std::reverse(vertices.begin(), vertices.end());
  return light.twoSided;
}

double lobeIntegral(const Ltc& lobe, std::span<const Eigen::Vector3d> vertices, HorizonClipping clipping,
                    const SphereTable& spheres) {
  switch (clipping) {
    case HorizonClipping::kExact:
      return std::max(0.0, ltcPolygonIntegral(lobe, vertices));
    case HorizonClipping::kProxySphere:
      return ltcPolygonIntegralByProxySphere(lobe, vertices);
    case HorizonClipping::kProxySphereTable:
      break;
  }
  return ltcPolygonIntegralBySphereTable(lobe, vertices, spheres);
}

TableEntry fetchAt(const Table& table, const SurfacePoint& point) {
  LobeParameters p;
  p.alphaX = point.alpha.x();
  p.alphaY = table.isIsotropic() ? point.alpha.x() : point.alpha.y();
  p.theta = std::atan2(std::hypot(point.wo.x(), point.wo.y()), point.wo.z());
  p.phi = table.isIsotropic() ? 0.0 : std::atan2(point.wo.y(), point.wo.x());
  return table.fetch(p);
}

Eigen::Vector3d shadeByTable(const Scene& scene, const SurfacePoint& point, const Table& table,
                             HorizonClipping clipping, const SphereTable& spheres) {
  const TableEntry entry = fetchAt(table, point);
  const bool usable = entry.invertible;  // else black, as the shader
  const Material& material = point.surface->material;
  const double reflectance = material.f0 * *entry.norm + (1.0 - material.f0) * *entry.fresnel;
  const Ltc lobe(usable ? entry.m : Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
  const Eigen::Matrix3d turn =
      table.isIsotropic() ? towardsView(point.wo) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const PolygonLight& light : scene.lights) {
    std::vector<Eigen::Vector3d> vertices = lightFrom(point, light);
    if (!turnToFront(light, vertices)) continue;
    double value = 0.0;
    if (material.diffuse > 0.0) value += material.diffuse * std::max(0.0, polygonIrradiance(vertices));
    for (Eigen::Vector3d& v : vertices) v = turn * v;
    if (usable) value += reflectance * lobeIntegral(lobe, vertices, clipping, spheres);
    sum += value * light.radiance;
  }
  return sum;
}

}  // namespace

std::string_view horizonClippingName(HorizonClipping clipping) {
  switch (clipping) {
    case HorizonClipping::kExact:
      return "exact";
    case HorizonClipping::kProxySphere:
      return "proxy-sphere";
    case HorizonClipping::kProxySphereTable:
      break;
  }
  return "proxy-sphere-table";
}

Film renderTwin(const Scene& scene, const Table& table, HorizonClipping clipping, int threads) {
  const std::vector<std::string>& channels = table.info().channels;
  for (const char* const needed : {"norm", "fresnel"}) {
    if (std::find(channels.begin(), channels.end(), needed) == channels.end())
      throw std::invalid_argument(fmt::format("the table has no {}", needed));
  }
  const SphereTable spheres;
  Film film(scene.camera.width, scene.camera.height);
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads > 0 ? threads : omp_get_max_threads())
  for (std::size_t row = 0; row < film.height; ++row) {
    for (std::size_t column = 0; column < film.width; ++column) {
      const PixelView view = viewPixel(scene, column, row);
      const std::size_t pixel = row * film.width + column;
      film.kinds[pixel] = view.kind;
      if (view.kind == PixelKind::kLight) film.radiance[pixel] = scene.lights[view.light].radiance;
      if (view.kind == PixelKind::kSurface)
        film.radiance[pixel] = shadeByTable(scene, view.point, table, clipping, spheres);
    }
  }
  return film;
}

}  // namespace ltcfit
