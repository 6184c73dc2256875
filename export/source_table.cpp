#include "export/source_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "export/atomic_file.h"
#include "export/little_endian.h"
#include "export/npy.h"
#include "export/published_table.h"
#include "export/table_arrays.h"
#include "export/text_arrays.h"
#include "export/texture_files.h"
#include "export/texture_metadata.h"

namespace ltcfit {
namespace {

constexpr std::size_t kEngineSide = 64;
// What is read of an array that broke off, for it to be told: less is some other list.
constexpr std::size_t kNotable = 16;
constexpr float kLargestHalfBits = 65535.0f;
constexpr float kNotableHalfBits =
    12288.0f;  // of 0.125: every table has larger numbers, and no other integers

// Our headers may have matrices only, and HDRP's never have more. Of other engines' files the second array
// was lost.
bool standsAlone(std::string_view name) {
  return name.ends_with("_matrix") || name.find("LtcMatrixData") != std::string_view::npos;
}

std::size_t countOf(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string_view::npos; at += part.size()) ++count;
  return count;
}

// Text that lost its end would else be a table without amplitudes, or of axes that only its metadata told.
void checkNotCutOff(std::string_view text, const std::string& name) {
  const std::size_t lastLine = text.rfind('\n') + 1;  // 0 where there is one line only
  const std::size_t comment = text.find("/*", lastLine);
  if (comment != std::string_view::npos && text.find("*/", comment + 2) == std::string_view::npos)
    throw InputError(name + ": cut off in a comment");
  if (countOf(text, "\n#if") > countOf(text, "\n#endif"))
    throw InputError(name + ": cut off: an #if without its #endif");
  if (text.find("export const LTC_INFO") != std::string_view::npos)
    throw InputError(name + ": cut off: no metadata behind LTC_INFO");
}

// Throws for an array that broke off, if one may be the table's.
void refuseDamaged(const std::vector<DamagedArray>& damaged, const std::string& name) {
  for (const DamagedArray& array : damaged) {
    if (roleOf(array.name) == Role::kUnknown && array.numbers < kNotable) continue;
    throw InputError(
        fmt::format("{}: {}: cut off, or something in it is no number: {} behind {} numbers (of 4 a texel: "
                    "texel {}, component "
                    "{})",
                    name, array.name, array.found.empty() ? "the end" : "'" + array.found + "'",
                    array.numbers, array.numbers / 4, array.numbers % 4));
  }
}

// Bits of halves become the numbers that they are.
void decodeHalves(std::vector<float>& values) {
  const bool integers = std::all_of(values.begin(), values.end(), [](float v) {
    return v >= 0.0f && v <= kLargestHalfBits && v == std::floor(v);
  });
  if (!integers || *std::max_element(values.begin(), values.end()) < kNotableHalfBits) return;
  for (float& v : values) v = halfValue(static_cast<std::uint16_t>(v));
}

bool isAnisotropic(const TextArray& array) {
  const std::vector<std::size_t>& s = array.shape;
  return (s.size() == 5 && s[4] == 9) || (s.size() == 6 && s[4] == 3 && s[5] == 3);
}

Table anisotropicTable(TextArray& matrices, const std::vector<TextArray>& arrays, const std::string& name) {
  if (productOf(matrices.shape) != matrices.values.size())
    throw InputError(name + ": " + matrices.name + ": its size is not its declaration");
  FloatArray array{matrices.shape, std::move(matrices.values)};
  array.shape.resize(4);
  array.shape.insert(array.shape.end(), {3, 3});
  const Table table = tableFrom2022(array, name);
  const auto amplitude = std::find_if(arrays.begin(), arrays.end(), [&](const TextArray& a) {
    return roleOf(a.name) == Role::kAmplitudes && a.values.size() == table.nodeCount() * 2;
  });
  if (amplitude == arrays.end()) return table;
  TableInfo info = table.info();
  info.channels.insert(info.channels.end(), {"norm", "fresnel"});
  std::vector<float> data;
  data.reserve(table.nodeCount() * 11);
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    const auto first = table.data().begin() + static_cast<std::ptrdiff_t>(i * 9);
    data.insert(data.end(), first, first + 9);
    data.insert(data.end(), {amplitude->values[2 * i], amplitude->values[2 * i + 1]});
  }
  return Table(std::move(info), std::move(data));
}

// The arrays that a file of ours describes itself: as many numbers as the textures have, in their order.
Table describedTable(PackedTable packed, const std::vector<TextArray>& arrays, const std::string& name) {
  std::size_t nodes = 1;
  for (const Axis& axis : packed.info.axes) nodes *= axis.size();
  const std::vector<TextureSpec>& textures = packed.packing.textures;
  std::size_t found = 0;
  std::vector<float> numbers;
  for (const TextArray& array : arrays) {
    // what else a file declares is not as long, or a member of the description
    if (array.isMember || found == textures.size() ||
        array.values.size() != nodes * textures[found].components.size())
      continue;
    numbers.insert(numbers.end(), array.values.begin(), array.values.end());
    ++found;
  }
  return tableFromPacked(packedFromNumbers(std::move(packed), numbers, name), name);
}

// Of arrays of one name the last one counts, as it does for a program.
std::vector<TextArray> withoutDoubles(std::vector<TextArray> arrays) {
  std::map<std::string, std::size_t> last;
  for (std::size_t i = 0; i < arrays.size(); ++i) last[arrays[i].name] = i;
  std::vector<TextArray> out;
  for (std::size_t i = 0; i < arrays.size(); ++i)
    if (last[arrays[i].name] == i) out.push_back(std::move(arrays[i]));
  return out;
}

}  // namespace

SourceContents contentsOfSource(std::string_view text, const std::string& name, bool isFirstOfTwo) {
  std::vector<DamagedArray> damaged;
  std::vector<TextArray> arrays = arraysOfText(text, &damaged);
  SourceContents contents;
  if (const std::optional<std::string> metadata = metadataOfSource(text)) {
    contents.table = describedTable(packedFromMetadata(*metadata, name), arrays, name);
    return contents;
  }
  arrays = withoutDoubles(std::move(arrays));
  contents.arrays = listOf(arrays);
  if (const auto matrices = std::find_if(arrays.begin(), arrays.end(), isAnisotropic);
      matrices != arrays.end()) {
    checkNotCutOff(text, name);
    refuseDamaged(damaged, name);
    contents.table = anisotropicTable(*matrices, arrays, name);
    return contents;
  }
  for (TextArray& array : arrays) decodeHalves(array.values);
  std::vector<Candidate> found = pairsOf(arrays, name);
  if (found.empty()) {
    refuseDamaged(damaged, name);
    found = matricesOf(arrays, name);
    if (found.empty()) return contents;
  }
  const Candidate chosen = bestOf(found, name, contents.arrays);
  const TextArray& matrices = *chosen.matrices;
  if (chosen.amplitudes == nullptr && !isFirstOfTwo && !standsAlone(matrices.name)) {
    // a list of numbers of some other kind
    if (!chosen.fits && chosen.names == 0) return contents;
    throw InputError(
        fmt::format("{}: {} without the array of norm and Fresnel: cut off, or in another file (--second)? "
                    "Arrays found: {}",
                    name, matrices.name, contents.arrays));
  }
  checkNotCutOff(text, name);
  contents.textures.push_back(imageOf(matrices, chosen.size));
  contents.names.push_back(matrices.name);
  if (chosen.amplitudes != nullptr) {
    contents.textures.push_back(imageOf(*chosen.amplitudes, chosen.size));
    contents.names.push_back(chosen.amplitudes->name);
  }
  return contents;
}

Image amplitudesOfSource(std::string_view text, const Image& first, const std::string& name) {
  std::vector<DamagedArray> damaged;
  std::vector<TextArray> arrays = withoutDoubles(arraysOfText(text, &damaged));
  refuseDamaged(damaged, name);
  checkNotCutOff(text, name);
  for (TextArray& array : arrays) decodeHalves(array.values);
  const TextureSize size{first.width, first.height};
  const std::vector<Candidate> found = amplitudesFor(arrays, size);
  if (found.empty()) {
    throw InputError(fmt::format("{}: no array of 2 to 4 numbers for each of {} x {} texels; found: {}", name,
                                 first.width, first.height, arrays.empty() ? "none" : listOf(arrays)));
  }
  return imageOf(*bestOf(found, name, listOf(arrays)).amplitudes, size);
}

std::optional<Table> tableFromSource(std::string_view text, const std::string& name) {
  SourceContents contents = contentsOfSource(text, name);
  if (contents.textures.empty()) return std::move(contents.table);
  const Image* const second = contents.textures.size() > 1 ? &contents.textures[1] : nullptr;
  return tableFrom2017(contents.textures[0], second, name);
}

std::optional<Table> tableFromEngineBinary(std::string_view bytes, const std::string& name) {
  constexpr std::size_t kNumbers = kEngineSide * kEngineSide * 4;
  std::vector<float> t1;
  std::vector<float> t2;
  if (bytes.size() == 4 + 2 * kNumbers * sizeof(float) && readAt<std::uint32_t>(bytes, 0) == 0x00010000) {
    t1 = readValues(bytes.substr(4, kNumbers * sizeof(float)), Precision::kFloat);
    t2 = readValues(bytes.substr(4 + kNumbers * sizeof(float)), Precision::kFloat);
  } else if (bytes.size() == 2 * kNumbers * sizeof(std::uint16_t)) {
    const std::vector<float> both = readValues(bytes, Precision::kHalf);
    for (std::size_t i = 0; i < both.size(); ++i) (i % 8 < 4 ? t1 : t2).push_back(both[i]);
  } else {
    return std::nullopt;
  }
  const auto image = [](std::vector<float> values) {
    Image square;
    square.width = square.height = kEngineSide;
    square.values = std::move(values);
    return square;
  };
  const Image second = image(std::move(t2));
  return tableFrom2017(image(std::move(t1)), &second, name);
}

}  // namespace ltcfit
