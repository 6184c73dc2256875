// Limits that every table of GGX lobes keeps, however it was fitted.
#pragma once

#include <string>
#include <vector>

#include "ltc/table.h"

namespace ltcfit {

/// The broken ones at these nodes, a sentence each with the worst texel and component:
///   mirror end: at alpha up to 0.05 the mean direction is the mirror direction;
///   normal view: the mean direction is the normal;
///   rough end: from alpha 0.9 on, for views up to 50 degrees, it is that of GGX, in length as well;
///   grazing view: from 80 degrees on it leans to GGX's side;
///   widths do not shrink with alpha, up to 70 degrees;
///   norm: in (0, 1], near GGX's, 1 at 90 degrees; Fresnel: in [0, norm], near GGX's.
/// Tolerances are such that the published tables, which are far off at a few grazing nodes, keep them. A
/// limit counts as broken where at least 1 node in 16 breaks it.
std::vector<std::string> brokenLimits(const Table& table, const std::vector<std::vector<std::size_t>>& nodes);

}  // namespace ltcfit
