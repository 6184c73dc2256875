#include "render/shader_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "export/atomic_file.h"
#include "export/packing.h"
#include "export/read_table.h"
#include "export/texture_files.h"

namespace ltcfit {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

bool hasAmplitudes(const Table& table) {
  const std::vector<std::string>& channels = table.info().channels;
  return std::count(channels.begin(), channels.end(), "norm") == 1 &&
         std::count(channels.begin(), channels.end(), "fresnel") == 1;
}

Packing shaderPacking(const Table& table) {
  return table.isIsotropic() ? packing2017() : packingOfRows();
}

// Node i of every axis where the shader's formula puts it.
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
    const std::size_t read = wanted.stores == MatrixStorage::kMinv && t == 1 ? 2 : asked.size();
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

Table withAmplitudes(const Table& table, const Table& amplitudes) {
  TableInfo info = table.info();
  std::vector<std::size_t> kept;
  info.channels.clear();
  for (std::size_t c = 0; c < table.channelCount(); ++c) {
    const std::string& channel = table.info().channels[c];
    if (channel == "norm" || channel == "fresnel") continue;
    info.channels.push_back(channel);
    kept.push_back(c);
  }
  info.channels.insert(info.channels.end(), {"norm", "fresnel"});
  std::vector<float> data;
  data.reserve(table.nodeCount() * info.channels.size());
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    for (std::size_t c : kept) data.push_back(table.data()[i * table.channelCount() + c]);
    const TableEntry entry = amplitudes.fetch(lookedUp(table, table.node(i)));
    data.insert(data.end(), {static_cast<float>(*entry.norm), static_cast<float>(*entry.fresnel)});
  }
  return Table(std::move(info), std::move(data));
}

std::vector<Image> shaderTextures(const PackedTable& packed) {
  if (packed.info.axes.size() == 2) return packed.images;
  return {stackedImage(packed)};
}

}  // namespace

ShaderTable loadShaderTable(const std::string& path, const Table* amplitudes) {
  TableFile file = readTableFile(path);
  if (!hasShaderAxes(file.table)) {
    throw InputError(
        fmt::format("{}: its axes are not those that ltc.glsl looks up ({})", path,
                    file.table.isIsotropic()
                        ? "theta by sqrt(1 - cos theta) and alpha by its root, from 0 to 90 degrees and "
                          "0 to 1"
                        : "alpha = max, lambda, theta and phi, all linear from 0 to 1 and 90 degrees"));
  }
  const Packing packing = shaderPacking(file.table);
  if (hasAmplitudes(file.table) && file.textures && hasShaderLayout(*file.textures, packing)) {
    const PackedTable& packed = *file.textures;
    return {shaderTextures(packed), std::move(file.table),
            fmt::format("read texel for texel from {}, {}", file.format,
                        packed.images[0].precision == Precision::kHalf ? "half" : "float32")};
  }
  std::string note = fmt::format("converted from {} to float32 textures", file.format);
  if (!hasAmplitudes(file.table)) {
    if (amplitudes == nullptr || !hasAmplitudes(*amplitudes) ||
        (amplitudes->isIsotropic() && !file.table.isIsotropic()))
      throw InputError(path + ": has no norm and Fresnel to shade with");
    file.table = withAmplitudes(file.table, *amplitudes);
    note += "; norm and Fresnel of another table";
  }
  try {
    const PackedTable packed = pack(file.table, packing, Precision::kFloat);
    return {shaderTextures(packed), unpack(packed), std::move(note)};
  } catch (const std::invalid_argument& error) {
    throw InputError(path + ": " + error.what());
  }
}

}  // namespace ltcfit
