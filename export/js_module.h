// A table as a JavaScript module.
#pragma once

#include <string>
#include <vector>

#include "export/packing.h"

namespace ltcfit {

/// An ES module that exports each texture as an array of numbers under the name told (of as many names as
/// textures), in the shortest digits that read back to the same float32, and `LTC_INFO`, the metadata as an
/// object.
std::string texturesToModule(const PackedTable& packed, const std::vector<std::string>& names);

}  // namespace ltcfit
