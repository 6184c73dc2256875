#include "render/light_texture_file.h"

#include <fmt/format.h>

#include <cmath>

#include "base/refusal.h"
#include "export/little_endian.h"

namespace ltcfit {

LightTextureFile toLightTextureFile(const PrefilteredTexture& texture, Precision precision) {
  LightTextureFile file{{}, texture.margin, texture.aspect, texture.lodScale};
  for (const PrefilteredLevel& level : texture.levels) {
    Image image;
    image.width = image.height = level.size;
    image.precision = precision;
    image.values.reserve(4 * level.texels.size());
    for (const Eigen::Vector3d& texel : level.texels) {
      for (const double channel : texel) {
        auto value = static_cast<float>(channel);
        if (precision == Precision::kHalf) value = halfValue(halfBits(value));
        if (!std::isfinite(value)) {
          throw Refusal(
              fmt::format("a radiance of {:.6g} is too large for {}", channel,
                          precision == Precision::kHalf ? "half precision; take --float" : "float32"));
        }
        image.values.push_back(value);
      }
      image.values.push_back(1.0f);
    }
    file.levels.push_back(std::move(image));
  }
  return file;
}

PrefilteredTexture fromLightTextureFile(const LightTextureFile& file) {
  PrefilteredTexture texture{file.margin, file.aspect, file.lodScale, {}};
  for (const Image& image : file.levels) {
    PrefilteredLevel level{image.width, {}};
    level.texels.reserve(image.texels());
    for (std::size_t i = 0; i < image.values.size(); i += 4) {
      level.texels.emplace_back(static_cast<double>(image.values[i]),
                                static_cast<double>(image.values[i + 1]),
                                static_cast<double>(image.values[i + 2]));
    }
    texture.levels.push_back(std::move(level));
  }
  return texture;
}

}  // namespace ltcfit
