#include "export/js_module.h"

#include <fmt/format.h>

#include "export/texture_metadata.h"

namespace ltcfit {

std::string texturesToModule(const PackedTable& packed, const std::vector<std::string>& names) {
  std::string out = "/*\n";
  for (const std::string& line : describeTextures(packed)) out += line.empty() ? " *\n" : " * " + line + "\n";
  out += " */\n";
  for (std::size_t t = 0; t < packed.images.size(); ++t) {
    const Image& image = packed.images[t];
    const std::size_t row = image.components * 4;
    out += fmt::format("export const {} = [", names[t]);
    for (std::size_t i = 0; i < image.values.size(); ++i)
      fmt::format_to(std::back_inserter(out), "{}{}", i == 0 ? "\n" : (i % row == 0 ? ",\n" : ","),
                     image.values[i]);
    out += "\n];\n";
  }
  const std::string metadata = metadataLine(packed, "exported arrays, in this order");
  out += fmt::format("export const LTC_INFO = {};\n", metadata.substr(metadata.find('{')));
  return out + fmt::format("// {}\n", metadata);
}

}  // namespace ltcfit
