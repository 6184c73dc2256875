#include "fit/target_lobe.h"

#include <string>

#include "base/refusal.h"
#include "ggx/ggx_lobe.h"

namespace ltcfit {

std::unique_ptr<Lobe> makeTargetLobe(std::string_view brdf, const LobeParameters& p) {
  if (brdf == "ggx")
    return std::make_unique<GgxLobe>(viewDirection(p.theta, p.phi), GgxAlpha{p.alphaX, p.alphaY});
  throw Refusal("brdf '" + std::string(brdf) + "' is not known (ggx)");
}

}  // namespace ltcfit
