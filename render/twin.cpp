#include "render/twin.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/parallel_for.h"
#include "base/refusal.h"
#include "ltc/polygon.h"
#include "ltc/sphere.h"
#include "render/textured_light.h"

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

// Whether the light of these vertices, relative to the point, emits towards it.
bool facesOrigin(const std::vector<Eigen::Vector3d>& vertices) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i)
    normal += (vertices[i] - vertices[0]).cross(vertices[i + 1] - vertices[0]);
  return normal.dot(vertices[0]) > 0.0;
}

struct Shading {
  const Scene& scene;
  const Table& table;
  const TwinOptions& options;
  SphereTable spheres;
};

// Integral over the light, times the colour of its texture. `turned`: their order was turned round.
Eigen::Vector3d received(const Shading& shading, const PolygonLight& light, const Ltc& lobe,
                         std::span<const Eigen::Vector3d> vertices, HorizonClipping clipping, bool turned) {
  double integral = 0.0;
  switch (clipping) {
    case HorizonClipping::kExact:
      integral = std::max(0.0, ltcPolygonIntegral(lobe, vertices));
      break;
    case HorizonClipping::kProxySphere:
      integral = ltcPolygonIntegralByProxySphere(lobe, vertices);
      break;
    case HorizonClipping::kProxySphereTable:
      integral = ltcPolygonIntegralBySphereTable(lobe, vertices, shading.spheres);
      break;
  }
  if (light.texture < 0) return Eigen::Vector3d::Constant(integral);
  // the texture knows the vertices in the light's own order
  std::array<Eigen::Vector3d, 4> corners;
  std::copy_n(vertices.begin(), 4, corners.begin());
  if (turned) std::reverse(corners.begin(), corners.end());
  const PrefilteredTexture& texture = shading.options.textures[static_cast<std::size_t>(light.texture)];
  return integral * fetchPrefiltered(texture, lobe.mInv(), corners);
}

TableEntry fetchAt(const Table& table, const SurfacePoint& point) {
  LobeParameters p;
  p.alphaX = point.alpha.x();
  p.alphaY = table.isIsotropic() ? point.alpha.x() : point.alpha.y();
  p.theta = std::atan2(std::hypot(point.wo.x(), point.wo.y()), point.wo.z());
  p.phi = table.isIsotropic() ? 0.0 : std::atan2(point.wo.y(), point.wo.x());
  return table.fetch(p);
}

Eigen::Vector3d shadeByTable(const Shading& shading, const SurfacePoint& point) {
  const TableEntry entry = fetchAt(shading.table, point);
  const bool usable = entry.invertible;  // else black, as the shader
  const Material& material = point.surface->material;
  const double reflectance = material.f0 * *entry.norm + (1.0 - material.f0) * entry.fresnel.value_or(0.0);
  const Ltc lobe(usable ? entry.m : Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
  const Ltc cosine{Eigen::Matrix3d(Eigen::Matrix3d::Identity())};
  const Eigen::Matrix3d turn =
      shading.table.isIsotropic() ? towardsView(point.wo) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const PolygonLight& light : shading.scene.lights) {
    std::vector<Eigen::Vector3d> vertices = lightFrom(point, light);
    if (std::none_of(vertices.begin(), vertices.end(), [](const auto& v) { return v.z() > 0.0; })) continue;
    const bool turned = !facesOrigin(vertices);
    if (turned && !light.twoSided) continue;
    if (turned) std::reverse(vertices.begin(), vertices.end());
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    if (material.diffuse > 0.0)
      value += material.diffuse * received(shading, light, cosine, vertices, HorizonClipping::kExact, turned);
    for (Eigen::Vector3d& v : vertices) v = turn * v;
    if (usable)
      value += reflectance * received(shading, light, lobe, vertices, shading.options.clipping, turned);
    sum += value.cwiseProduct(light.radiance);
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

Film renderTwin(const Scene& scene, const Table& table, const TwinOptions& options) {
  const std::vector<std::string>& channels = table.info().channels;
  const auto need = [&](const char* channel) {
    if (std::find(channels.begin(), channels.end(), channel) == channels.end())
      throw Refusal(fmt::format("the table has no {}", channel));
  };
  need("norm");
  if (scene.needsFresnel()) need("fresnel");
  for (const PolygonLight& light : scene.lights) {
    if (light.texture >= static_cast<int>(options.textures.size()))
      throw std::invalid_argument(
          fmt::format("a light has texture {} of {}", light.texture, options.textures.size()));
    if (light.texture >= 0 && light.vertices.size() != 4)
      throw std::invalid_argument(fmt::format("a light of {} vertices has a texture", light.vertices.size()));
  }
  const Shading shading{scene, table, options, SphereTable()};
  Film film(scene.camera.width, scene.camera.height);
  parallelFor(film.height, {.threads = options.threads}, [&](std::size_t row) {
    for (std::size_t column = 0; column < film.width; ++column) {
      const PixelView view = viewPixel(scene, column, row);
      const std::size_t pixel = row * film.width + column;
      film.kinds[pixel] = view.kind;
      if (view.kind == PixelKind::kLight) film.radiance[pixel] = view.radiance;
      if (view.kind == PixelKind::kSurface) film.radiance[pixel] = shadeByTable(shading, view.point);
    }
  });
  return film;
}

}  // namespace ltcfit
