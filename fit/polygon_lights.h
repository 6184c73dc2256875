// The lights that the light-space fit compares on: quads, with the true integral of the lobe over each.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ggx/contour_integral.h"
#include "ggx/lobe.h"
#include "ltc/quad.h"

namespace ltcfit {

/// What a difference counts over a light that holds the share `integral` of the lobe.
enum class LightWeighting {
  kAbsolute,  ///< the difference itself
  kRelative,  ///< over `integral`, and a floor of 1 %
  kMixed,     ///< over the square root of the same
};
std::string_view lightWeightingName(LightWeighting weighting);
/// "absolute", "relative", "mixed"; Refusal for another name.
LightWeighting lightWeightingFromName(std::string_view name);

struct PolygonLightOptions {
  int lights = 1024;  ///< 16..65536; a 16th as many lie below the horizon in addition
  LightWeighting weighting = LightWeighting::kAbsolute;
  /// Differences of a light of half-size s count s^-sizeExponent, in -4..4: 0 is what the renderer sees, more
  /// favours small lights.
  double sizeExponent = 0.4;
  std::uint64_t seed = 1;

  /// False with a message naming the option, its value and its range.
  bool isValid(std::string* error) const;
};

/// One light of the family.
struct IntegratedLight {
  Quad quad;
  double integral;  ///< of the lobe, eval / albedo, over it: what an LTC should give, 0..1
  double weight;    ///< of the difference, > 0; the squares of a family's weights average about 1
};

struct PolygonLights {
  std::vector<IntegratedLight> lights;
  double integralError = 0.0;  ///< estimated largest error of an integral
};

/// A stratified family of rectangular lights at distance 1, half-sizes 0.02 to 1.5, sides s a and s / a with
/// a in 1/2..2, through the horizon as it comes. Their directions are uniform over the upper hemisphere in
/// one part; in the others a direction of the LTC `near` lies on a random point of the light, or of its rim,
/// within two widths of the LTC: so lobes of any width are met, and most where a difference can show. Weights
/// make up for the difference in density, so that the weighted mean of squares is that over lights uniform on
/// the hemisphere, to some 10 % for large lights. Lights below the horizon, where the lobe is 0, come at the
/// end.
///
/// The same numbers for every lobe, so that neighbours in a table see the same noise. `truth` and `albedo`
/// are the lobe's; `near` should be close to it, det != 0.
PolygonLights makePolygonLights(const ContourIntegrator& truth, double albedo, const Eigen::Matrix3d& near,
                                const PolygonLightOptions& options);

}  // namespace ltcfit
