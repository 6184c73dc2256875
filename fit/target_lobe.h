// From the parameters of a table's node to the lobe that it stands for.
#pragma once

#include <memory>
#include <string_view>

#include "ggx/lobe.h"
#include "ltc/table.h"

namespace ltcfit {

/// The lobe of a table's brdf (TableInfo::brdf) at these parameters. The one place where lobes are named: a
/// new one is added here. Throws Refusal for an unknown name.
std::unique_ptr<Lobe> makeTargetLobe(std::string_view brdf, const LobeParameters& parameters);

}  // namespace ltcfit
