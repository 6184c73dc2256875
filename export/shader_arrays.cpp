#include "export/shader_arrays.h"

#include <fmt/format.h>

#include "export/c_text.h"
#include "export/texture_metadata.h"

namespace ltcfit {

std::string texturesToShader(const PackedTable& packed, const std::string& prefix, ShadingLanguage language) {
  const std::string name = identifier(prefix);
  const std::string guard = upper(name) + "_INCLUDED";
  const bool glsl = language == ShadingLanguage::kGlsl;
  const char* const vector = glsl ? "vec" : "float";
  std::string out;
  for (const std::string& line : describeTextures(packed)) out += line.empty() ? "//\n" : "// " + line + "\n";
  out += "// The texel of coordinates (x, y, z) in nodes is element x + width * (y + height * z).\n";
  out += fmt::format("#ifndef {0}\n#define {0}\n\n", guard);
  const Image& first = packed.images[0];
  out += fmt::format("{} int {}_width = {};\n{} int {}_height = {};\n", glsl ? "const" : "static const", name,
                     first.width, glsl ? "const" : "static const", name, first.height);
  for (std::size_t t = 0; t < packed.images.size(); ++t) {
    const Image& image = packed.images[t];
    const std::string type = fmt::format("{}{}", vector, image.components);
    const std::size_t count = image.texels();
    const std::string array = fmt::format("{}_{}", name, packed.packing.textures[t].name);
    out += glsl ? fmt::format("\nconst {0} {1}[{2}] = {0}[{2}](\n", type, array, count)
                : fmt::format("\nstatic const {} {}[{}] = {{\n", type, array, count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto texel = image.values.begin() + static_cast<std::ptrdiff_t>(i * image.components);
      // nine digits of a float32 read back to the same number
      fmt::format_to(std::back_inserter(out), "  {}({:.8e}){}\n", type,
                     fmt::join(texel, texel + static_cast<std::ptrdiff_t>(image.components), ", "),
                     i + 1 < count ? "," : "");
    }
    out += glsl ? ");\n" : "};\n";
  }
  return out + fmt::format("\n#endif  // {}\n", guard);
}

}  // namespace ltcfit
