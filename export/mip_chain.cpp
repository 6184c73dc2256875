#include "export/mip_chain.h"

#include <algorithm>
#include <bit>

namespace ltcfit {

std::vector<Image> mipLevels(const Image& finest, std::size_t count) {
  std::vector<Image> levels(count);
  for (std::size_t l = 0; l < count; ++l) {
    levels[l].width = std::max<std::size_t>(1, finest.width >> l);
    levels[l].height = std::max<std::size_t>(1, finest.height >> l);
    levels[l].components = finest.components;
    levels[l].precision = finest.precision;
  }
  return levels;
}

bool isMipChain(const std::vector<Image>& levels) {
  if (levels.empty()) return false;
  const Image& finest = levels[0];
  const std::size_t most = std::bit_width(std::max(finest.width, finest.height));
  if (levels.size() > std::min(most, kMaxLevels) || finest.width == 0 || finest.height == 0) return false;
  const std::vector<Image> expected = mipLevels(finest, levels.size());
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const Image& level = levels[l];
    if (level.width != expected[l].width || level.height != expected[l].height || level.depth != 1 ||
        level.layers != 1 || level.components != 4 || level.precision != finest.precision ||
        level.values.size() != level.texels() * 4)
      return false;
  }
  return true;
}

}  // namespace ltcfit
