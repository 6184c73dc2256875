// Writes the look-ups of tailoredTables for the tests that run and compile them: write_lookups FOLDER.
//   lookups_glsl.inc, lookups_hlsl.inc  all, and kLookups (tests/render/shader.h) to call them by: C++
//   NAME.glsl, NAME.hlsl                 one, and a main() that calls it, to follow ltc.glsl or ltc.hlsl
#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "export/atomic_file.h"
#include "export/shader_lookup.h"
#include "tests/support/tailored.h"

namespace ltcfit::test {
namespace {

using Arguments = std::map<std::string, std::string>;

std::string glslProgram(const ShaderLookup& lookup) {
  const Arguments names{
      {"matrixTable", "first"}, {"amplitudeTable", "second"}, {"table", "volume"}, {"roughness", "at.x"},
      {"nDotV", "at.y"},        {"alphaX", "at.x"},           {"alphaY", "at.y"},  {"view", "view"}};
  return lookup.source +
         fmt::format(
             "uniform sampler2D first;\nuniform sampler2D second;\nuniform sampler3D volume;\n"
             "in vec2 at;\nin vec3 view;\nout vec4 colour;\nvoid main() {{\n"
             "  LtcEntry entry = {};\n"
             "  colour = vec4(entry.inverse * view, entry.norm + entry.fresnel);\n}}\n",
             lookup.call(names));
}

std::string hlslProgram(const ShaderLookup& lookup) {
  const Arguments names{{"matrixTable", "first"}, {"amplitudeTable", "second"}, {"table", "volume"},
                        {"bilinear", "linearly"}, {"roughness", "s.at.x"},      {"nDotV", "s.at.y"},
                        {"alphaX", "s.at.x"},     {"alphaY", "s.at.y"},         {"view", "s.view"}};
  return lookup.source +
         fmt::format(
             "Texture2D first;\nTexture2D second;\nTexture3D volume;\nSamplerState linearly;\n"
             "struct Surface {{ float2 at : A; float3 view : V; }};\n"
             "float4 main(Surface s) : SV_Target {{\n  LtcEntry entry = {};\n"
             "  return float4(mul(entry.inverse, s.view), entry.norm + entry.fresnel);\n}}\n",
             lookup.call(names));
}

void write(const std::filesystem::path& folder, ShadingLanguage language) {
  const bool glsl = language == ShadingLanguage::kGlsl;
  const std::string ending = glsl ? "glsl" : "hlsl";
  const std::string first = glsl ? "{{&first}}" : "{&first}";
  const Arguments arguments{{"matrixTable", first},
                            {"amplitudeTable", glsl ? "{{&second}}" : "{&second}"},
                            {"table", first},
                            {"bilinear", "{}"},
                            {"roughness", "a.roughness"},
                            {"nDotV", "a.nDotV"},
                            {"alphaX", "a.alphaX"},
                            {"alphaY", "a.alphaY"},
                            {"view", "from(a.view)"}};
  std::string sources;
  std::string table;
  const auto add = [&](const std::string& name, const TableInfo& info) {
    const ShaderLookup lookup = makeShaderLookup(info, language, name);
    sources += lookup.source;
    table += fmt::format(
        "    {{\"{}\", []([[maybe_unused]] const Texture& first, [[maybe_unused]] const Texture& second,\n"
        "        [[maybe_unused]] const ltcfit::test::LookupArguments& a) {{ return to({}); }}}},\n",
        name, lookup.call(arguments));
    writeFileAtomically((folder / (name + "." + ending)).string(),
                        glsl ? glslProgram(lookup) : hlslProgram(lookup));
  };
  for (const Tailored& t : tailoredTables()) add(t.name, t.table.info());
  // a fault: 0.4 is right
  TableInfo wrong = tailoredTable("isoRange").info();
  wrong.axes[1].warp[0] = 0.405;
  add("wrongWarp", wrong);
  writeFileAtomically((folder / ("lookups_" + ending + ".inc")).string(),
                      sources + "constexpr ltcfit::test::Lookup kLookups[] = {\n" + table + "};\n");
}

}  // namespace
}  // namespace ltcfit::test

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  for (const auto language : {ltcfit::ShadingLanguage::kGlsl, ltcfit::ShadingLanguage::kHlsl})
    ltcfit::test::write(argv[1], language);
}
