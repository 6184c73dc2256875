#include "fit/target_lobe.h"

#include <stdexcept>
#include <string>

#include "ggx/ggx_lobe.h"

namespace ltcfit {

std::unique_ptr<Lobe> makeTargetLobe(std::string_view brdf, const LobeParameters& p) {
  if (brdf == "ggx")
    return std::make_unique<GgxLobe>(viewDirection(p.theta, p.phi), GgxAlpha{p.alphaX, p.alphaY});
  throw std::invalid_argument("brdf '" + std::string(brdf) + "' is not known (ggx)");
}

}  // namespace ltcfit
