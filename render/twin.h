// The double-precision twin of the GL shading check: the same look-up in the same table and the exact polygon
// integral, in double arithmetic.
#pragma once

#include <span>
#include <string_view>

#include "ltc/table.h"
#include "render/film.h"
#include "render/prefilter.h"
#include "render/scene.h"

namespace ltcfit {

/// How a light that goes through the lobe's horizon is clipped there.
enum class HorizonClipping {
  kExact,             ///< edge by edge (ltc/polygon.h): what ltc.glsl does
  kProxySphere,       ///< a sphere of the same vector form factor, by the closed fit of Hill and Heitz 2016
  kProxySphereTable,  ///< the same sphere, its form factor from a texture of 64 x 64, t2.w of the layout of
                      ///< 2017
};
inline constexpr std::size_t kHorizonClippings = 3;

/// "exact", "proxy-sphere", "proxy-sphere-table".
std::string_view horizonClippingName(HorizonClipping clipping);

struct TwinOptions {
  HorizonClipping clipping = HorizonClipping::kExact;
  /// The scene's textures, prefiltered, in the order of Scene::textures.
  std::span<const PrefilteredTexture> textures;
  int threads = 0;  ///< 0 = all cores. Does not change the picture
};

/// Reflected radiance towards the camera. Each light adds its radiance times
///   (f0 norm + (1 - f0) fresnel) Psi(lobe) colour(lobe) + diffuse Psi(cosine) colour(cosine),
/// Psi the integral of the LTC that the table yields here, and of the clamped cosine, over the light (Heitz
/// et al. 2016, eq. 10 and 11), 0 behind a one-sided light and where all of a light is below the surface's
/// horizon; colour the fetch of a texture (section 5.4), 1 without one. The cosine's integral is always
/// clipped exactly. `table` as the shader reads it (storedAs); an isotropic one reads alpha.x(). Where a
/// look-up has no inverse the lobe adds nothing. Throws Refusal for a table without norm,
/// or without fresnel where some f0 is below 1, std::invalid_argument for a light whose texture is not given.
Film renderTwin(const Scene& scene, const Table& table, const TwinOptions& options = {});

}  // namespace ltcfit
