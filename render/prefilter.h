// Prefiltered textures of lights (Heitz et al. 2016, section 5.3): a chain of mip maps, each level the
// picture under a Gaussian that cannot leak out of it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "render/scene.h"

namespace ltcfit {

/// Of the finest level, in its texels.
inline constexpr double kPrefilterSigma = 0.5;

struct PrefilterOptions {
  /// Of the texture around the picture, on each side, in sides of the picture; 0..4. With 1/2 the texels of a
  /// picture whose sides are powers of two are those of the finest level.
  double margin = 0.5;
  /// By how much sigma grows with the distance from the picture, both in the same unit; 0.1..10. This and the
  /// margin: the least error of the colours, weighted by the light they colour, of four pictures under lobes
  /// of the isotropic table (render_test --gtest_filter='PrefilterAccuracy*' prints it).
  double spread = 1.4;
  /// Width / height of the light, 1/64..64. The Gaussian is round on a light of this shape; the shader's
  /// sigma is in units of the root of its area, whatever the shape.
  double aspect = 1.0;
  /// Side of the finest level, a power of two, 4..4096; 0: the smallest that has as many texels along the
  /// picture as the picture has.
  std::size_t size = 0;
  int threads = 0;  ///< 0: as many as OpenMP gives
};

/// One level: `size` x `size` texels, row by row from the top.
struct PrefilteredLevel {
  std::size_t size = 0;
  std::vector<Eigen::Vector3d> texels;
};

/// The texture covers [-margin, 1 + margin]^2 of texture coordinates, the picture [0, 1]^2; v = 0 is its top
/// row. Read trilinearly, clamped to the edge, at level lodOfSigma.
struct PrefilteredTexture {
  double margin = 0.0;
  double aspect = 1.0;
  double lodScale = 0.0;                 ///< 1 / sigma of level 0 as it is read
  std::vector<PrefilteredLevel> levels;  ///< from the finest on, down to one texel
};

/// Level of detail at which the texture, read bilinearly, looks as under a Gaussian of `sigma`, in units of
/// the root of the light's area: log2(lodScale sigma). What the bilinear look-up itself blurs is part of it.
/// Not bounded: a sampler clamps it. sigma > 0.
double lodOfSigma(const PrefilteredTexture& texture, double sigma);
double sigmaOfLod(const PrefilteredTexture& texture, double lod);

/// At x, y in texels, the centre of the first one at 0; clamped to the edge.
Eigen::Vector3d bilinear(const PrefilteredLevel& level, double x, double y);

/// Side of the finest level that `prefilter` makes. Throws Refusal for options out of range and
/// a picture without texels.
std::size_t prefilteredSize(const LightTexture& picture, const PrefilterOptions& options);

/// Level k is the picture, read bilinearly as LightTexture tells, under a Gaussian of
///   sigma = hypot(kPrefilterSigma 2^k texels of the finest level, spread distance to the picture),
/// integrated over the picture alone and normalised there. Distances and sigma are those on a light of the
/// option's aspect and unit area. Inside the picture levels are exact; in the margin a sigma between those of
/// two levels is blended from both, linearly in log2(sigma), as the sampler blends. Does not depend on the
/// number of threads. Throws Refusal for options out of range and for empty pictures.
PrefilteredTexture prefilter(const LightTexture& picture, const PrefilterOptions& options);

}  // namespace ltcfit
