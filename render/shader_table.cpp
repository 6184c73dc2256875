#include "render/shader_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <utility>

#include "base/angles.h"
#include "base/refusal.h"
#include "export/atomic_file.h"
#include "export/packing.h"
#include "export/read_table.h"
#include "export/texture_files.h"
#include "ltc/resample.h"

namespace ltcfit {
namespace {

bool has(const Table& table, std::string_view channel) {
  const std::vector<std::string>& channels = table.info().channels;
  return std::find(channels.begin(), channels.end(), channel) != channels.end();
}

// Node i of every axis where the formula of ltc.glsl puts it.
bool hasShaderAxes(const Table& table) {
  const std::vector<Axis>& axes = table.info().axes;
  if (table.isIsotropic())
    return axes[0].spans(AxisMap::kSqrtOneMinusCos, kHalfPi) && axes[1].spans(AxisMap::kSqrt, 1.0);
  const AxisMap linear = AxisMap::kLinear;
  return axes[0].name == "alpha" && axes[0].spans(linear, 1.0) && axes[1].spans(linear, 1.0) &&
         axes[2].spans(linear, kHalfPi) && axes[3].spans(linear, kHalfPi);
}

// Whether the textures are those that the shader reads, as far as it reads them.
bool hasShaderLayout(const PackedTable& packed, const Packing& wanted) {
  const Packing& is = packed.packing;
  if (is.stores != wanted.stores || is.textures.size() != wanted.textures.size()) return false;
  // dividing by something else changes what is interpolated, but for the shader every scale will do
  if (is.stores == MatrixStorage::kMinv && is.divisor != wanted.divisor) return false;
  for (std::size_t t = 0; t < is.textures.size(); ++t) {
    const std::vector<std::string>& components = is.textures[t].components;
    const std::vector<std::string>& asked = wanted.textures[t].components;
    const std::size_t read = wanted.stores == MatrixStorage::kMinv && t == 1
                                 ? std::min<std::size_t>(2, asked.size())
                                 : asked.size();
    if (components.size() != read && components.size() != asked.size()) return false;
    if (!std::equal(asked.begin(), asked.begin() + static_cast<std::ptrdiff_t>(read), components.begin()))
      return false;
  }
  return true;
}

// The parameters at which a look-up yields the node, which at the ends of axes are not quite those that it
// was fitted at: two tables of the same axes have the same amplitudes.
LobeParameters lookedUp(const Table& table, const std::vector<std::size_t>& node) {
  std::vector<double> at;
  for (std::size_t a = 0; a < node.size(); ++a)
    at.push_back(table.info().axes[a].valueFromTexel(static_cast<double>(node[a])));
  if (table.isIsotropic()) return {at[1], at[1], at[0], 0.0};
  return {at[0], at[0] * at[1], at[2], at[3]};
}

// Of norm and fresnel what the one lacks and the other has.
std::vector<std::string> missingIn(const Table& table, const Table& amplitudes) {
  std::vector<std::string> missing;
  for (const char* const channel : {"norm", "fresnel"})
    if (!has(table, channel) && has(amplitudes, channel)) missing.emplace_back(channel);
  return missing;
}

Table withAmplitudes(const Table& table, const Table& amplitudes, const std::vector<std::string>& added) {
  TableInfo info = table.info();
  info.channels.insert(info.channels.end(), added.begin(), added.end());
  std::vector<float> data;
  data.reserve(table.nodeCount() * info.channels.size());
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    for (std::size_t c = 0; c < table.channelCount(); ++c)
      data.push_back(table.data()[i * table.channelCount() + c]);
    const TableEntry entry = amplitudes.fetch(lookedUp(table, table.node(i)));
    for (const std::string& channel : added)
      data.push_back(static_cast<float>(channel == "norm" ? *entry.norm : *entry.fresnel));
  }
  return Table(std::move(info), std::move(data));
}

// What to know of a table that does not answer for every lobe.
std::string limitsText(const Table& table) {
  std::string text;
  for (std::size_t a = 0; a < table.info().axes.size(); ++a) {
    const AxisReach reach = reachOf(table.info(), a);
    const Axis& axis = table.info().axes[a];
    const bool angle = axis.unit == "rad";
    if (reach.low == 0.0 && reach.high == (angle ? kHalfPi : 1.0)) continue;
    const double unit = angle ? 180.0 / std::numbers::pi : 1.0;
    text += fmt::format("{}{} {:.4g}", text.empty() ? "" : ", ", axis.name, reach.low * unit);
    if (reach.high > reach.low) text += fmt::format("..{:.4g}", reach.high * unit);
    if (angle) text += " degrees";
  }
  if (!text.empty()) text = fmt::format("; only {}, the nearest end for other lobes", text);
  if (!has(table, "fresnel")) text += "; no fresnel: scenes of f0 = 1 only";
  return text;
}

std::vector<Image> shaderTextures(const PackedTable& packed) {
  if (packed.info.axes.size() == 2) return packed.images;
  return {stackedImage(packed)};
}

}  // namespace

bool ShaderTable::hasFresnel() const {
  return has(table, "fresnel");
}

ShaderTable loadShaderTable(const std::string& path, const Table* amplitudes) {
  return makeShaderTable(readTableFile(path), path, amplitudes);
}

ShaderTable makeShaderTable(TableFile file, const std::string& path, const Table* amplitudes) {
  try {
    std::vector<std::string> added;
    if (amplitudes != nullptr && amplitudes->isIsotropic() == file.table.isIsotropic())
      added = missingIn(file.table, *amplitudes);
    if (!added.empty()) file.table = withAmplitudes(file.table, *amplitudes, added);
    if (!has(file.table, "norm")) throw Refusal("has no norm to shade with");
    const bool standard = hasShaderAxes(file.table) && has(file.table, "fresnel");
    std::optional<ShaderLookup> lookup;
    if (!standard) lookup = makeShaderLookup(file.table.info(), ShadingLanguage::kGlsl, "ltcTable");
    const Packing packing = !standard                  ? packingLean(file.table.info())
                            : file.table.isIsotropic() ? packing2017()
                                                       : packingOfRows();
    if (added.empty() && file.textures && hasShaderLayout(*file.textures, packing)) {
      const PackedTable& packed = *file.textures;
      const bool half = packed.images[0].precision == Precision::kHalf;
      std::string note = fmt::format("read texel for texel from {}, {}{}", file.format,
                                     half ? "half" : "float32", limitsText(file.table));
      return {shaderTextures(packed), std::move(file.table), std::move(note), std::move(lookup)};
    }
    const PackedTable packed = pack(file.table, packing, Precision::kFloat);
    return {shaderTextures(packed), unpack(packed),
            fmt::format("converted from {} to float32 textures{}{}", file.format,
                        added.empty() ? std::string()
                                      : fmt::format("; {} of another table", fmt::join(added, " and ")),
                        limitsText(file.table)),
            std::move(lookup)};
  } catch (const Refusal& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace ltcfit
