#include "export/read_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "export/atomic_file.h"
#include "export/chebyshev_file.h"
#include "export/dds.h"
#include "export/exr.h"
#include "export/json_table.h"
#include "export/ktx2.h"
#include "export/little_endian.h"
#include "export/npy.h"
#include "export/published_table.h"
#include "export/second_texture.h"
#include "export/source_table.h"
#include "export/texture_files.h"
#include "export/texture_metadata.h"

namespace ltcfit {
namespace {

// Sidecars hold a header and a few axes.
constexpr std::uint64_t kMaxSidecar = std::uint64_t{1} << 26;
// 64^4 nodes of 9 numbers in binary; in JSON 32^4.
constexpr std::uint64_t kMaxTable = std::uint64_t{1} << 30;

// The metadata beside a file, if there are any. That they are the file's own is checked, not believed.
std::optional<PackedTable> readSidecar(const std::string& path, std::string_view bytes) {
  const std::string beside = sidecarPath(path);
  if (!std::filesystem::is_regular_file(beside)) return std::nullopt;
  const std::string text = readFile(beside, kMaxSidecar);
  if (!isTextureMetadata(text)) return std::nullopt;
  PackedTable packed = packedFromMetadata(text, beside);
  const std::string sum = checksum(bytes);
  const bool known = std::any_of(packed.files.begin(), packed.files.end(),
                                 [&](const auto& file) { return file.second == sum; });
  if (packed.files.empty())
    throw InputError(fmt::format("{}: names no files with checksums; export {} again", beside, path));
  if (!known) {
    throw InputError(fmt::format(
        "{}: describes another file than {} (its checksum is not among the described ones); export "
        "again, or move the description away",
        beside, path));
  }
  return packed;
}

Image imageOfArray(const FloatArray& array, const std::string& name) {
  if (array.shape.size() != 3) {
    throw InputError(
        fmt::format("{}: shape ({}) is neither (y, x, 4), the 2017 table, nor (alpha, lambda, theta, "
                    "phi, 3, 3), the 2022 one; for other arrays {} is needed",
                    name, fmt::join(array.shape, ", "), sidecarPath(name)));
  }
  Image image;
  image.height = array.shape[0];
  image.width = array.shape[1];
  image.components = array.shape[2];
  image.values = array.values;
  return image;
}

// One texture file, without a look at its metadata.
Image readImage(const std::string& bytes, const std::string& path) {
  if (isNpy(bytes)) return imageOfArray(parseNpy(bytes, path), path);
  if (isKtx2(bytes)) return parseKtx2(bytes, path).image;
  if (isDds(bytes)) return parseDds(bytes, path);
  throw InputError(path + ": neither .npy, DDS nor KTX2");
}

// The file of each texture: the one given, and those that its metadata name beside it.
std::vector<Image> readFiles(const PackedTable& packed, const std::string& bytes, const std::string& path) {
  std::vector<Image> images;
  for (const auto& [name, sum] : packed.files) {
    if (sum == checksum(bytes)) {
      images.push_back(readImage(bytes, path));
      continue;
    }
    const std::string file = (std::filesystem::path(path).parent_path() / name).string();
    if (!std::filesystem::is_regular_file(file))
      throw InputError(fmt::format("{}: not there, and {} is one of several files", file, path));
    const std::string other = readFile(file, kMaxTable);
    if (std::filesystem::path(name) == std::filesystem::path(path).filename())
      throw InputError(
          fmt::format("{}: holds what {} calls another file: swapped or renamed", path, sidecarPath(path)));
    if (checksum(other) != sum)
      throw InputError(
          fmt::format("{}: does not belong to {} (its checksum is another one than described)", file, path));
    images.push_back(readImage(other, file));
  }
  return images;
}

std::vector<Image> layersOf(const Image& image) {
  std::vector<Image> layers;
  const std::size_t count = image.width * image.height * image.depth * image.components;
  for (std::size_t l = 0; l < image.layers; ++l) {
    Image layer = image;
    layer.layers = 1;
    const auto begin = image.values.begin() + static_cast<std::ptrdiff_t>(l * count);
    layer.values.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    layers.push_back(std::move(layer));
  }
  return layers;
}

bool looksLikeText(std::string_view bytes) {
  return bytes.find('\0') == std::string_view::npos;
}

// What is read, and the remarks to make about it.
struct Reading {
  const ReadOptions& options;
  std::vector<std::string> notes;
  bool tookSecond = false;
  bool tookLayout = false;
};

std::optional<std::string> secondTexturePath(const std::string& path, const ReadOptions& options) {
  return options.second.empty() ? secondTextureBeside(path) : options.second;
}

// Norm and Fresnel for the texels of `first`, from any file of one texture.
Image readSecond(const std::string& path, const Image& first) {
  const std::string bytes = readFile(path, kMaxTable);
  const bool isText = !isNpy(bytes) && !isDds(bytes) && !isKtx2(bytes) && looksLikeText(bytes);
  Image second = isText ? amplitudesOfSource(bytes, first, path) : readImage(bytes, path);
  refuseNonFinite(second, {}, path);
  return second;
}

// A table of one texture or two; where it is one, the second is its second layer or another file.
PackedTable packedWithoutMetadata(std::vector<Image> textures, const std::string& path, Reading& reading) {
  for (std::size_t t = 0; t < textures.size(); ++t)
    refuseNonFinite(textures[t], {}, textures.size() == 1 ? path : fmt::format("{}: texture {}", path, t));
  if (textures.size() == 1 && textures[0].layers == 2) textures = layersOf(textures[0]);
  if (textures.size() == 1) {
    if (const std::optional<std::string> second = secondTexturePath(path, reading.options)) {
      reading.notes.push_back(fmt::format("{}: norm and Fresnel are taken from {}", path, *second));
      reading.tookSecond = true;
      textures.push_back(readSecond(*second, textures[0]));
    }
  }
  reading.tookLayout = true;
  return packedUndescribed(textures[0], textures.size() > 1 ? &textures[1] : nullptr, reading.options.layout,
                           path, reading.notes);
}

TableFile fileOf(PackedTable packed, const std::string& format, const std::string& path) {
  Table table = tableFromPacked(packed, path);
  return {std::move(table), format, std::move(packed), {}};
}

TableFile readTexture(const std::string& bytes, const std::string& path, Reading& reading) {
  if (isKtx2(bytes)) {
    const Ktx2File file = parseKtx2(bytes, path);
    for (const auto& [key, value] : file.keyValues) {
      if (key == kMetadataKey)
        return fileOf(packedFromStack(packedFromMetadata(value, path), file.image, path), "KTX2", path);
    }
    if (std::optional<PackedTable> packed = readSidecar(path, bytes)) {
      packed->images = readFiles(*packed, bytes, path);
      return fileOf(std::move(*packed), "KTX2", path);
    }
    return fileOf(packedWithoutMetadata({file.image}, path, reading), "KTX2", path);
  }
  std::optional<PackedTable> packed = readSidecar(path, bytes);
  if (isNpy(bytes)) {
    if (packed && packed->files.size() > 1) {
      packed->images = readFiles(*packed, bytes, path);
      return fileOf(std::move(*packed), ".npy", path);
    }
    const FloatArray array = parseNpy(bytes, path);
    if (packed) return fileOf(packedFromNumbers(std::move(*packed), array.values, path), ".npy", path);
    if (array.shape.size() == 6) {
      reading.tookLayout = true;
      return {tableFromArray(array, reading.options.layout, path, reading.notes), ".npy", std::nullopt, {}};
    }
    return fileOf(packedWithoutMetadata({imageOfArray(array, path)}, path, reading), ".npy", path);
  }
  const Image image = parseDds(bytes, path);
  if (!packed) return fileOf(packedWithoutMetadata({image}, path, reading), "DDS", path);
  if (packed->files.size() == 1) return fileOf(packedFromStack(std::move(*packed), image, path), "DDS", path);
  packed->images = readFiles(*packed, bytes, path);
  return fileOf(std::move(*packed), "DDS", path);
}

// What a binary without a header of its own holds, texture after texture.
std::vector<float> numbersOfBinary(std::string_view bytes, const PackedTable& packed,
                                   const std::string& path) {
  if (packed.container == kPlayCanvasContainer && bytes.size() >= 4) bytes.remove_prefix(4);
  const std::size_t size = packed.precision == Precision::kHalf ? 2 : 4;
  if (bytes.size() % size != 0)
    throw InputError(fmt::format("{}: {} bytes are no whole count of numbers", path, bytes.size()));
  const std::vector<float> numbers = readValues(bytes, packed.precision);
  if (packed.container != kBabylonContainer) return numbers;
  std::vector<float> first;
  std::vector<float> second;
  for (std::size_t i = 0; i < numbers.size(); ++i) (i % 8 < 4 ? first : second).push_back(numbers[i]);
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

// The table in a text, which need not hold one: then `arrays` tells what was found instead.
std::optional<TableFile> readSource(const std::string& text, const std::string& path, Reading& reading,
                                    std::string& arrays) {
  SourceContents contents =
      contentsOfSource(text, path, secondTexturePath(path, reading.options).has_value());
  arrays = contents.arrays;
  if (!contents.textures.empty()) {
    contents.table =
        tableFromPacked(packedWithoutMetadata(std::move(contents.textures), path, reading), path);
  }
  if (!contents.table) return std::nullopt;
  return TableFile{std::move(*contents.table), "source code", std::nullopt, {}};
}

// Whether a JSON object is a table of ours, damaged or not.
bool isTableJson(std::string_view text) {
  return text.find("\"format\"") != std::string_view::npos || text.find("\"axes\"") != std::string_view::npos;
}

TableFile readAny(const std::string& path, Reading& reading) {
  const std::string bytes = readFile(path, kMaxTable);
  if (isNpy(bytes) || isDds(bytes) || isKtx2(bytes)) return readTexture(bytes, path, reading);
  if (isExr(bytes)) return fileOf(packedFromExr(bytes, path), "EXR", path);
  // a byte order mark, as editors of one vendor leave it, is not part of the text
  const std::size_t start = bytes.find_first_not_of(" \t\r\n", bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0);
  if (start == std::string::npos) throw InputError(path + ": is empty");
  if (bytes[start] == '{') {
    if (isTextureMetadata(bytes))
      throw InputError(path + ": describes a texture file; give that one (the name without .json)");
    if (isChebyshevJson(bytes))
      return {tableOfChebyshev(chebyshevFromJson(bytes, path)), "Chebyshev form", std::nullopt, {}};
    if (isTableJson(bytes)) return {tableFromJson(bytes, path), "JSON", std::nullopt, {}};
    checkJson(bytes, path);
  }
  std::string arrays;
  if (looksLikeText(bytes)) {
    if (std::optional<TableFile> file = readSource(bytes, path, reading, arrays)) return std::move(*file);
  }
  // a few numbers may have no zero byte
  if (std::optional<PackedTable> packed = readSidecar(path, bytes)) {
    const std::vector<float> numbers = numbersOfBinary(bytes, *packed, path);
    return fileOf(packedFromNumbers(std::move(*packed), numbers, path), "binary", path);
  }
  if (!looksLikeText(bytes)) {
    if (std::optional<Table> table = tableFromEngineBinary(bytes, path))
      return {std::move(*table), "binary", std::nullopt, {}};
  }
  throw InputError(
      fmt::format("{}: not a table: neither ltcfit's JSON, KTX2, EXR, DDS or .npy, source code or JSON with "
                  "the arrays of one, "
                  "nor PlayCanvas' or Babylon.js' binary{}",
                  path, arrays.empty() ? std::string() : "; arrays found: " + arrays));
}

}  // namespace

std::vector<std::string> filesOfTable(const std::string& path, const ReadOptions& options) {
  std::vector<std::string> files{path};
  const std::string beside = sidecarPath(path);
  std::error_code error;
  if (std::filesystem::is_regular_file(beside, error)) {
    files.push_back(beside);
    try {
      for (const auto& [name, sum] : packedFromMetadata(readFile(beside, kMaxSidecar), beside).files)
        files.push_back((std::filesystem::path(path).parent_path() / name).string());
    } catch (const InputError&) {
      // not a description: still not to be overwritten by accident
    }
  }
  if (const std::optional<std::string> second = secondTexturePath(path, options)) files.push_back(*second);
  return files;
}

Table readTable(const std::string& path, const ReadOptions& options) {
  return readTableFile(path, options).table;
}

TableFile readTableFile(const std::string& path, const ReadOptions& options) {
  Reading reading{options, {}};
  TableFile file = readAny(path, reading);
  if (!options.second.empty() && !reading.tookSecond) {
    throw InputError(
        fmt::format("--second {}: {} has its norm and Fresnel, or a description of where they are, already",
                    options.second, path));
  }
  if (!options.layout.empty() && !reading.tookLayout)
    throw InputError(fmt::format("layout '{}': {} says itself what its numbers mean", options.layout, path));
  file.notes = std::move(reading.notes);
  return file;
}

}  // namespace ltcfit
