#include "export/source_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "export/atomic_file.h"
#include "export/little_endian.h"
#include "export/npy.h"
#include "export/published_table.h"
#include "export/text_arrays.h"
#include "export/texture_files.h"
#include "export/texture_metadata.h"

namespace ltcfit {
namespace {

constexpr std::size_t kEngineTexels = 64 * 64;

// A square texture of so many components; nothing where the count is not that of one.
std::optional<Image> squareImage(std::vector<float> values, std::size_t components) {
  const std::size_t texels = values.size() / components;
  const auto side = static_cast<std::size_t>(std::llround(std::sqrt(static_cast<double>(texels))));
  if (side < 2 || side * side * components != values.size()) return std::nullopt;
  Image image;
  image.width = side;
  image.height = side;
  image.components = components;
  image.values = std::move(values);
  return image;
}

// Whether `text` ends with one of these, in whatever case.
bool isNamed(std::string name, std::span<const std::string_view> endings) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::any_of(endings.begin(), endings.end(), [&](std::string_view e) { return name.ends_with(e); });
}

constexpr std::array<std::string_view, 5> kMatrixNames{"ltc_mat_1", "_matrix", "ltc_mat_ggx", "ltcmat",
                                                       "ltc1"};
constexpr std::array<std::string_view, 5> kAmplitudeNames{"ltc_mat_2", "_amplitude", "ltc_mag_ggx", "ltcamp",
                                                          "ltc2"};

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

// Throws where one of these names is that of an array that broke off.
void refuseDamaged(const std::vector<std::string>& damaged, std::span<const std::string_view> endings,
                   const std::string& name) {
  for (const std::string& array : damaged) {
    if (isNamed(array, endings))
      throw InputError(name + ": " + array + ": cut off, or something in it is no number");
  }
}

Table anisotropicTable(TextArray& matrices, const std::vector<TextArray>& arrays, const std::string& name) {
  FloatArray array{matrices.shape, std::move(matrices.values)};
  array.shape.back() = 3;
  array.shape.push_back(3);
  std::size_t count = 1;
  for (std::size_t s : array.shape) {
    if (s == 0 || s > array.values.size()) count = 0;
    count *= s;  // six factors of at most the file's length: checked next, wrapped or not
  }
  if (count != array.values.size())
    throw InputError(name + ": " + matrices.name + ": its size is not its declaration");
  const Table table = tableFrom2022(array, name);
  const auto amplitude = std::find_if(arrays.begin(), arrays.end(), [&](const TextArray& a) {
    return a.name == matrices.name + "_amplitude" && a.values.size() == table.nodeCount() * 2;
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
    // what else a file declares, or writes in its comment, is not as long
    if (found == textures.size() || array.values.size() != nodes * textures[found].components.size())
      continue;
    numbers.insert(numbers.end(), array.values.begin(), array.values.end());
    ++found;
  }
  return tableFromPacked(packedFromNumbers(std::move(packed), numbers, name), name);
}

}  // namespace

std::optional<Table> tableFromSource(std::string_view text, const std::string& name) {
  std::vector<std::string> damaged;
  std::vector<TextArray> arrays = arraysOfText(text, &damaged);
  const std::optional<std::string> metadata = metadataOfSource(text);
  if (metadata) return describedTable(packedFromMetadata(*metadata, name), arrays, name);
  for (TextArray& array : arrays) {
    if (array.shape.size() == 5 && array.shape.back() == 9) {
      checkNotCutOff(text, name);
      refuseDamaged(damaged, kAmplitudeNames, name);
      return anisotropicTable(array, arrays, name);
    }
  }
  refuseDamaged(damaged, kMatrixNames, name);
  refuseDamaged(damaged, kAmplitudeNames, name);
  const TextArray* matrices = nullptr;
  const TextArray* amplitudes = nullptr;
  for (const TextArray& array : arrays) {
    if (isNamed(array.name, kMatrixNames)) matrices = &array;
    if (isNamed(array.name, kAmplitudeNames)) amplitudes = &array;
  }
  if (matrices == nullptr) return std::nullopt;
  checkNotCutOff(text, name);
  const std::optional<Image> first = squareImage(matrices->values, 4);
  if (!first) {
    throw InputError(fmt::format("{}: {} holds {} numbers, which are no square texture of 4", name,
                                 matrices->name, matrices->values.size()));
  }
  if (amplitudes == nullptr) {
    // our headers may have matrices only; of the engines' files the second array was lost
    if (!matrices->name.ends_with("_matrix"))
      throw InputError(name + ": " + matrices->name + " without the array of norm and Fresnel: cut off?");
    return tableFrom2017(*first, nullptr, name);
  }
  const std::size_t components = amplitudes->values.size() / first->texels();
  const std::optional<Image> second =
      squareImage(amplitudes->values, std::clamp<std::size_t>(components, 1, 4));
  if (!second) {
    throw InputError(fmt::format("{}: {} holds {} numbers, which do not go with {}", name, amplitudes->name,
                                 amplitudes->values.size(), matrices->name));
  }
  return tableFrom2017(*first, &*second, name);
}

std::optional<Table> tableFromEngineBinary(std::string_view bytes, const std::string& name) {
  constexpr std::size_t kNumbers = kEngineTexels * 4;
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
  const std::optional<Image> first = squareImage(std::move(t1), 4);
  const std::optional<Image> second = squareImage(std::move(t2), 4);
  return tableFrom2017(*first, &*second, name);
}

}  // namespace ltcfit
