// The families of random lights that the metrics form and light_s, light_m, light_l average over.
#pragma once

#include <array>

#include "ggx/moments.h"
#include "ggx/random.h"
#include "ltc/quad.h"

namespace ltcfit {

/// A quad of the metric `form`: on the plane tangent to the lobe's mean direction, centre N(0, I) 1.5 spread,
/// half-sizes exp(0.7 N(0, 1)) 1.5 spread, angle uniform.
Quad randomFormQuad(const LobeMoments& moments, Random& random);

/// A light of the metrics light_s, light_m, light_l: direction of the centre uniform over the upper
/// hemisphere, on the tangent plane at distance 1, half-sizes s a and s / a with a = exp(0.4 N(0, 1)), angle
/// uniform.
Quad randomLight(double size, Random& random);

/// Sizes s of light_s, light_m and light_l.
inline constexpr std::array<double, 3> kLightSizes{0.05, 0.25, 0.8};

}  // namespace ltcfit
