#include "export/engine_source.h"

#include <fmt/format.h>

#include "export/c_text.h"
#include "export/little_endian.h"
#include "export/texture_metadata.h"

namespace ltcfit {
namespace {

std::string commentBlock(const PackedTable& packed) {
  std::string out = "/*\n";
  for (const std::string& line : describeTextures(packed)) out += line.empty() ? " *\n" : " * " + line + "\n";
  return out + " */\n";
}

std::string metadataBlock(const PackedTable& packed) {
  return fmt::format("/* {} */\n", metadataLine(packed, "arrays, in this order"));
}

}  // namespace

std::string texturesToBlender(const PackedTable& packed) {
  std::string out = commentBlock(packed) + "\n#include \"eevee_lut.hh\"\n\nnamespace blender::eevee::lut {\n";
  for (std::size_t t = 0; t < packed.images.size(); ++t) {
    const Image& image = packed.images[t];
    out += fmt::format("\nconst float {}[{}][{}][{}] = {{\n", packed.packing.textures[t].name, image.height,
                       image.width, image.components);
    const std::size_t row = image.width * image.components;
    for (std::size_t y = 0; y < image.height; ++y) {
      const auto first = image.values.begin() + static_cast<std::ptrdiff_t>(y * row);
      const std::vector<float> values(first, first + static_cast<std::ptrdiff_t>(row));
      out += fmt::format(" {{\n{} }}{}\n", bracedRows(values, image.components),
                         y + 1 < image.height ? "," : "");
    }
    out += "};\n";
  }
  return out + "\n}  // namespace blender::eevee::lut\n" + metadataBlock(packed);
}

std::string texturesToUnreal(const PackedTable& packed) {
  std::string out = commentBlock(packed);
  out += fmt::format("#pragma once\n\nstatic const int LTC_Size = {};\n", packed.images[0].width);
  for (std::size_t t = 0; t < packed.images.size(); ++t) {
    const Image& image = packed.images[t];
    out += fmt::format("\nconst float {}[LTC_Size * LTC_Size][{}] = {{\n{}}};\n",
                       packed.packing.textures[t].name, image.components,
                       bracedRows(image.values, image.components));
  }
  return out + metadataBlock(packed);
}

std::string texturesToUnity(const PackedTable& packed) {
  const Image& image = packed.images[0];
  std::string out = commentBlock(packed);
  out +=
      "namespace UnityEngine.Rendering.HighDefinition\n{\n    internal partial class LTCAreaLight\n    {\n"
      "        internal static ushort[] s_LtcMatrixData_GGX = new ushort[]\n        {";
  for (std::size_t i = 0; i < image.values.size(); ++i)
    fmt::format_to(std::back_inserter(out), "{}0x{:04X},", i % 16 == 0 ? "\n            " : " ",
                   halfBits(image.values[i]));
  out += "\n        };\n    }\n}\n";
  return out;
}

}  // namespace ltcfit
