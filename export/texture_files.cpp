#include "export/texture_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/refusal.h"
#include "export/atomic_file.h"
#include "export/c_text.h"
#include "export/exr.h"
#include "export/little_endian.h"
#include "export/npy.h"
#include "export/texture_metadata.h"

namespace ltcfit {
namespace {

constexpr std::string_view kComponentNames = "RGBA";
constexpr const char* kWriter = "ltcfit " LTCFIT_VERSION;
// Above every table (ltc/table.cpp), and below what overflows a product of sizes.
constexpr std::size_t kMaxNodes = std::size_t{1} << 28;
constexpr std::size_t kMaxComponents = 16;

// Adds the metadata of the files written so far: beside each of them, so that it does not matter which of
// several is named.
void addSidecars(std::vector<ExportFile>& files, PackedTable packed, const std::string& container) {
  packed.files.clear();
  for (const ExportFile& file : files) packed.files.emplace_back(file.name, checksum(file.bytes));
  const std::size_t count = files.size();
  for (std::size_t i = 0; i < count; ++i)
    files.push_back({sidecarPath(files[i].name), textureMetadata(packed, container)});
}

// Name of a channel in an EXR file.
std::string exrChannel(const Packing& packing, std::size_t texture, std::size_t component) {
  if (packing.textures.size() == 1) return packing.textures[0].components[component];
  const std::string letter(1, kComponentNames[component]);
  return texture == 0 ? letter : packing.textures[texture].name + "." + letter;
}

// An anisotropic table's textures are volumes, if of one slice only.
bool isVolume(const PackedTable& packed) {
  return packed.info.axes.size() == 4;
}

constexpr const char* kOneFileEach = "one file a texture";

bool haveEqualComponents(const std::vector<Image>& images) {
  return std::all_of(images.begin(), images.end(),
                     [&](const Image& image) { return image.components == images[0].components; });
}

// "x.dds": "x-1.dds", "x-2.dds", ...
std::vector<std::string> numberedNames(const std::string& name, std::size_t count) {
  const std::filesystem::path path(name);
  std::vector<std::string> names;
  for (std::size_t t = 0; t < count; ++t)
    names.push_back(fmt::format("{}-{}{}", path.stem().string(), t + 1, path.extension().string()));
  return names;
}

std::string stackText(const PackedTable& packed) {
  if (!isVolume(packed)) return "one texture a layer";
  return fmt::format("textures stacked in depth, {} slices each", packed.images[0].depth);
}

// An image of the size that a texture of this packing has.
Image imageFor(const PackedTable& packed, std::size_t texture) {
  const std::vector<Axis>& axes = packed.info.axes;
  Image image;
  image.precision = packed.precision;
  image.components = packed.packing.textures[texture].components.size();
  if (axes.size() != 2 && axes.size() != 4) throw Refusal("axes: need two or four");
  if (image.components == 0 || image.components > kMaxComponents)
    throw Refusal("a texture needs 1 to 16 components");
  std::size_t nodes = 1;
  for (const Axis& axis : axes) {
    if (axis.size() > kMaxNodes / nodes) throw Refusal("axes: more nodes than any table has");
    nodes *= axis.size();
  }
  image.width = axes.back().size();
  image.height = axes[axes.size() - 2].size();
  image.depth = axes.size() == 4 ? axes[0].size() * axes[1].size() : 1;
  return image;
}

}  // namespace

Image stackedImage(const PackedTable& packed) {
  Image stack = packed.images[0];
  for (std::size_t t = 1; t < packed.images.size(); ++t) {
    const Image& image = packed.images[t];
    if (image.components != stack.components) throw Refusal("textures differ in components");
    stack.values.insert(stack.values.end(), image.values.begin(), image.values.end());
    (isVolume(packed) ? stack.depth : stack.layers) += image.depth;
  }
  return stack;
}

std::vector<Image> unstackedImages(const Image& stack, const PackedTable& packed) {
  std::vector<Image> images;
  std::size_t at = 0;
  for (std::size_t t = 0; t < packed.packing.textures.size(); ++t) {
    Image image = imageFor(packed, t);
    const std::size_t count = image.texels() * image.components;
    if (image.width != stack.width || image.height != stack.height || image.components != stack.components ||
        count > stack.values.size() - at) {
      throw Refusal("the size of the texture does not fit the axes");
    }
    const auto begin = stack.values.begin() + static_cast<std::ptrdiff_t>(at);
    image.values.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    at += count;
    images.push_back(std::move(image));
  }
  if (at != stack.values.size()) throw Refusal("the size of the texture does not fit the axes");
  return images;
}

std::vector<ExportFile> toKtx2Files(const PackedTable& packed, Ktx2Compression compression,
                                    const std::string& name) {
  if (!haveEqualComponents(packed.images)) {
    const std::vector<std::string> names = numberedNames(name, packed.images.size());
    std::vector<ExportFile> files;
    for (std::size_t t = 0; t < names.size(); ++t)
      files.push_back({names[t], imageToKtx2({packed.images[t], {{"KTXwriter", kWriter}}}, compression)});
    addSidecars(files, packed, kOneFileEach);
    return files;
  }
  Ktx2File file;
  file.image = stackedImage(packed);
  file.keyValues = {{"KTXwriter", kWriter}, {kMetadataKey, textureMetadata(packed, stackText(packed))}};
  return {{name, imageToKtx2(file, compression)}};
}

std::vector<ExportFile> toDdsFiles(PackedTable packed, DdsHeader header, const std::string& name) {
  if (haveEqualComponents(packed.images)) {
    const Image stack = stackedImage(packed);
    if (stack.layers == 1 || header == DdsHeader::kDx10) {
      std::vector<ExportFile> files{{name, imageToDds(stack, header)}};
      addSidecars(files, packed, stackText(packed));
      return files;
    }
  }
  const std::vector<std::string> names = numberedNames(name, packed.images.size());
  return toDdsFiles(std::move(packed), header, names);
}

std::vector<ExportFile> toDdsFiles(PackedTable packed, DdsHeader header,
                                   const std::vector<std::string>& names) {
  std::vector<ExportFile> files;
  for (std::size_t t = 0; t < packed.images.size(); ++t)
    files.push_back({names[t], imageToDds(packed.images[t], header)});
  addSidecars(files, packed, kOneFileEach);
  return files;
}

std::vector<ExportFile> toExrFiles(const PackedTable& packed, const std::string& name) {
  ExrFile file;
  const Image& first = packed.images[0];
  const bool volume = isVolume(packed);
  file.width = volume ? first.width * first.height : first.width;
  file.height = volume ? first.depth : first.height;
  file.precision = packed.precision;
  for (std::size_t t = 0; t < packed.images.size(); ++t) {
    const Image& image = packed.images[t];
    for (std::size_t c = 0; c < image.components; ++c) {
      std::vector<float> channel(image.texels());
      for (std::size_t i = 0; i < channel.size(); ++i) channel[i] = image.values[i * image.components + c];
      file.names.push_back(exrChannel(packed.packing, t, c));
      file.channels.push_back(std::move(channel));
    }
  }
  const TableInfo& info = packed.info;
  const std::string layout =
      volume
          ? fmt::format("x = phi + {} theta, y = lambda + {} alpha (nodes)", first.width, info.axes[1].size())
          : std::string("x = alpha, y = theta (nodes); first row of the file is normal incidence");
  std::string contents;
  for (const TextureSpec& texture : packed.packing.textures)
    contents += fmt::format("{}{} = ({})", contents.empty() ? "" : ", ", texture.name,
                            fmt::join(texture.components, ", "));
  file.attributes = {{kMetadataKey, textureMetadata(packed, layout)},
                     {"ltcContents", contents},
                     {"ltcLayout", layout},
                     {"ltcMatrix", matrixText(packed)},
                     {"ltcCommand", info.provenance.command},
                     {"comments", "Linearly Transformed Cosines for GGX; not colours: no colour management"}};
  for (const Axis& axis : info.axes) file.attributes.emplace_back("ltcAxis_" + axis.name, axisFormula(axis));
  return {{name, channelsToExr(file)}};
}

std::vector<ExportFile> toNpyFiles(const PackedTable& packed, const std::string& name) {
  std::vector<std::size_t> nodes;
  for (const Axis& axis : packed.info.axes) nodes.push_back(axis.size());
  if (!haveEqualComponents(packed.images)) {
    const std::vector<std::string> names = numberedNames(name, packed.images.size());
    std::vector<ExportFile> files;
    for (std::size_t t = 0; t < names.size(); ++t) {
      FloatArray array{nodes, packed.images[t].values};
      array.shape.push_back(packed.images[t].components);
      files.push_back({names[t], arrayToNpy(array, packed.precision)});
    }
    addSidecars(files, packed, kOneFileEach);
    return files;
  }
  FloatArray array;
  if (packed.images.size() > 1) array.shape.push_back(packed.images.size());
  for (const std::size_t n : nodes) array.shape.push_back(n);
  array.shape.push_back(packed.images[0].components);
  for (const Image& image : packed.images)
    array.values.insert(array.values.end(), image.values.begin(), image.values.end());
  std::vector<ExportFile> files{{name, arrayToNpy(array, packed.precision)}};
  addSidecars(
      files, packed,
      packed.images.size() > 1 ? "array (textures, axes.., components)" : "array (axes.., components)");
  return files;
}

std::vector<ExportFile> toRawFiles(const PackedTable& packed, std::string bytes, const std::string& name,
                                   const std::string& container) {
  std::vector<ExportFile> files{{name, std::move(bytes)}};
  addSidecars(files, packed, container);
  return files;
}

std::vector<ExportFile> toRawFiles(const PackedTable& packed, const std::string& name) {
  std::string bytes;
  for (const Image& image : packed.images) appendValues(bytes, image.values, packed.precision);
  return toRawFiles(packed, std::move(bytes), name, kRawContainer);
}

void refuseNonFinite(const Image& image, const std::vector<std::string>& components,
                     const std::string& name) {
  const auto bad =
      std::find_if(image.values.begin(), image.values.end(), [](float v) { return !std::isfinite(v); });
  if (bad == image.values.end()) return;
  const auto at = static_cast<std::size_t>(bad - image.values.begin());
  const std::size_t component = at % image.components;
  const std::size_t texel = at / image.components;
  const std::size_t row = texel / image.width;
  const std::size_t slice = row / image.height;
  std::string place =
      fmt::format("texel y {}, x {}, component {}", row % image.height, texel % image.width, component);
  if (component < components.size()) place += " (" + components[component] + ")";
  if (image.depth > 1) place = fmt::format("slice z {}, {}", slice % image.depth, place);
  if (image.layers > 1) place = fmt::format("layer {}, {}", slice / image.depth, place);
  throw InputError(fmt::format("{}: {} is not finite", name, place));
}

Table tableFromPacked(const PackedTable& packed, const std::string& name) {
  for (std::size_t t = 0; t < packed.images.size() && t < packed.packing.textures.size(); ++t) {
    const TextureSpec& texture = packed.packing.textures[t];
    const bool alone = packed.packing.textures.size() == 1;
    refuseNonFinite(packed.images[t], texture.components,
                    alone ? name : fmt::format("{}: texture '{}'", name, texture.name));
  }
  try {
    return unpack(packed);
  } catch (const Refusal& error) {
    throw InputError(name + ": " + error.what());
  }
}

PackedTable packedFromStack(PackedTable packed, const Image& stack, const std::string& name) {
  try {
    packed.images = unstackedImages(stack, packed);
    return packed;
  } catch (const Refusal& error) {
    throw InputError(name + ": " + error.what());
  }
}

PackedTable packedFromExr(std::string_view bytes, const std::string& name) {
  const ExrFile file = parseExr(bytes, name);
  const auto metadata = std::find_if(file.attributes.begin(), file.attributes.end(),
                                     [](const auto& a) { return a.first == kMetadataKey; });
  if (metadata == file.attributes.end())
    throw InputError(name + ": an EXR image, but not one of ltcfit's (no attribute 'ltcfit')");
  PackedTable packed = packedFromMetadata(metadata->second, name);
  std::vector<Image> images;
  std::size_t components = 0;
  try {
    for (std::size_t t = 0; t < packed.packing.textures.size(); ++t) {
      Image image = imageFor(packed, t);
      // each is read from a channel of its own: a few bytes of names must not ask for an image each
      components += image.components;
      if (components > file.names.size()) throw Refusal("EXR: fewer channels than components");
      const bool volume = isVolume(packed);
      if (file.width != (volume ? image.width * image.height : image.width) ||
          file.height != (volume ? image.depth : image.height) ||
          (packed.packing.textures.size() > 1 && image.components > kComponentNames.size())) {
        throw Refusal("the size of the image does not fit the axes");
      }
      image.values.resize(image.texels() * image.components);
      for (std::size_t c = 0; c < image.components; ++c) {
        const std::string channel = exrChannel(packed.packing, t, c);
        const auto at = std::find(file.names.begin(), file.names.end(), channel);
        if (at == file.names.end()) throw Refusal("EXR: no channel '" + channel + "'");
        const std::vector<float>& values = file.channels[static_cast<std::size_t>(at - file.names.begin())];
        for (std::size_t i = 0; i < values.size(); ++i) image.values[i * image.components + c] = values[i];
      }
      images.push_back(std::move(image));
    }
  } catch (const Refusal& error) {
    throw InputError(name + ": " + error.what());
  }
  packed.images = std::move(images);
  return packed;
}

PackedTable packedFromNumbers(PackedTable packed, const std::vector<float>& numbers,
                              const std::string& name) {
  std::vector<Image> images;
  std::size_t at = 0;
  try {
    for (std::size_t t = 0; t < packed.packing.textures.size(); ++t) {
      Image image = imageFor(packed, t);
      const std::size_t count = image.texels() * image.components;
      if (count > numbers.size() - at) throw Refusal("too few numbers for the axes");
      const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(at);
      image.values.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
      at += count;
      images.push_back(std::move(image));
    }
    if (at != numbers.size()) throw Refusal("more numbers than the axes have nodes");
  } catch (const Refusal& error) {
    throw InputError(name + ": " + error.what());
  }
  packed.images = std::move(images);
  return packed;
}

}  // namespace ltcfit
