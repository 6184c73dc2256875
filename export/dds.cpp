#include "export/dds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>

#include "base/refusal.h"
#include "export/atomic_file.h"
#include "export/little_endian.h"
#include "export/mip_chain.h"

// Layout: "DDS Programming Guide" (Microsoft): magic, DDS_HEADER of 124 bytes, DDS_HEADER_DXT10 of 20 where
// the FourCC is "DX10", then the texels.
namespace ltcfit {
namespace {

constexpr std::string_view kDdsMagic = "DDS ";
constexpr std::size_t kLegacySize = 128;
constexpr std::size_t kDx10Size = 148;
constexpr std::uint32_t kDx10 = 0x30315844;  // "DX10"
// DDSD_: what the header says
constexpr std::uint32_t kCaps = 0x1, kHeight = 0x2, kWidth = 0x4, kPitch = 0x8, kPixelFormat = 0x1000,
                        kMipCount = 0x20000, kDepth = 0x800000;
constexpr std::uint32_t kFourCc = 0x4;                                          // DDPF_
constexpr std::uint32_t kComplex = 0x8, kTexture = 0x1000, kMipMap = 0x400000;  // DDSCAPS_
constexpr std::uint32_t kCubeMap = 0x200 | 0xFC00, kVolume = 0x200000;          // DDSCAPS2_
constexpr std::uint32_t kTexture2d = 3, kTexture3d = 4;                         // D3D10_RESOURCE_DIMENSION_
constexpr std::size_t kMaxDdsSide = 16384;                                      // of Direct3D 11, 2D
constexpr std::size_t kMaxSlices = 2048;  // of volumes and arrays there, 2D

struct DdsFormat {
  std::uint32_t fourCc;  // D3DFMT
  std::uint32_t dxgi;
  std::size_t components;
  Precision precision;
};
constexpr std::array<DdsFormat, 6> kDdsFormats{{{113, 10, 4, Precision::kHalf},
                                                {116, 2, 4, Precision::kFloat},
                                                {112, 34, 2, Precision::kHalf},
                                                {115, 16, 2, Precision::kFloat},
                                                {111, 54, 1, Precision::kHalf},
                                                {114, 41, 1, Precision::kFloat}}};

// Throws for a format that there is none of.
const DdsFormat& ddsFormatOf(const Image& image) {
  for (const DdsFormat& f : kDdsFormats) {
    if (f.components == image.components && f.precision == image.precision) return f;
  }
  throw Refusal("DDS: need 1, 2 or 4 components a texel");
}

std::string headerOf(const Image& image, DdsHeader header, std::size_t levels) {
  const DdsFormat& format = ddsFormatOf(image);
  const bool volume = image.depth > 1;
  const auto u32 = [](std::size_t v) { return static_cast<std::uint32_t>(v); };
  std::string out(kDdsMagic);
  append(out, std::uint32_t{124});
  append(out, kCaps | kHeight | kWidth | kPitch | kPixelFormat | (volume ? kDepth : 0u) |
                  (levels > 1 ? kMipCount : 0u));
  append(out, u32(image.height));
  append(out, u32(image.width));
  append(out, u32(image.width * image.components * image.bytesPerValue()));
  append(out, u32(image.depth));
  append(out, u32(levels));
  out.append(11 * sizeof(std::uint32_t), '\0');
  append(out, std::uint32_t{32});
  append(out, kFourCc);
  append(out, header == DdsHeader::kDx10 ? kDx10 : format.fourCc);
  out.append(5 * sizeof(std::uint32_t), '\0');  // bit masks of integer formats
  append(out,
         kTexture | (volume || image.layers > 1 || levels > 1 ? kComplex : 0u) | (levels > 1 ? kMipMap : 0u));
  append(out, volume ? kVolume : 0u);
  out.append(3 * sizeof(std::uint32_t), '\0');
  if (header == DdsHeader::kDx10) {
    append(out, format.dxgi);
    append(out, volume ? kTexture3d : kTexture2d);
    append(out, std::uint32_t{0});
    append(out, u32(image.layers));
    append(out, std::uint32_t{0});
  }
  return out;
}

// What the header says: the finest level, without its values, and how many levels there are.
struct ParsedHeader {
  Image image;
  std::size_t levels = 1;
  std::size_t size = kLegacySize;
};

ParsedHeader parseDdsHeader(std::string_view bytes, const std::string& name) {
  if (!isDds(bytes) || bytes.size() < kLegacySize || readAt<std::uint32_t>(bytes, 4) != 124)
    throw InputError(name + ": not a DDS file, or cut off in its header");
  const std::uint32_t fourCc = readAt<std::uint32_t>(bytes, 84);
  const std::uint32_t caps2 = readAt<std::uint32_t>(bytes, 112);
  const bool dx10 = fourCc == kDx10;
  if (dx10 && bytes.size() < kDx10Size) throw InputError(name + ": DDS file cut off in its DX10 header");
  const std::uint32_t code = dx10 ? readAt<std::uint32_t>(bytes, kLegacySize) : fourCc;
  ParsedHeader header;
  Image& image = header.image;
  bool known = false;
  for (const DdsFormat& f : kDdsFormats) {
    if (code != (dx10 ? f.dxgi : f.fourCc)) continue;
    image.components = f.components;
    image.precision = f.precision;
    known = true;
  }
  if (!known) {
    throw InputError(fmt::format("{}: DDS {} {} is not known (RGBA, RG or R, half or float)", name,
                                 dx10 ? "DXGI format" : "FourCC", code));
  }
  if ((caps2 & kCubeMap) != 0) throw InputError(name + ": DDS cube map; need a plain texture");
  header.levels = std::max(1u, readAt<std::uint32_t>(bytes, 28));
  image.height = readAt<std::uint32_t>(bytes, 12);
  image.width = readAt<std::uint32_t>(bytes, 16);
  const bool volume =
      dx10 ? readAt<std::uint32_t>(bytes, kLegacySize + 4) == kTexture3d : (caps2 & kVolume) != 0;
  if (volume) image.depth = readAt<std::uint32_t>(bytes, 24);
  if (dx10) image.layers = readAt<std::uint32_t>(bytes, kLegacySize + 12);
  if (dx10) header.size = kDx10Size;
  for (std::size_t side : {image.width, image.height, image.depth, image.layers}) {
    if (side == 0 || side > kMaxDdsSide)
      throw InputError(fmt::format("{}: DDS header: a size of {}; need 1 to {}", name, side, kMaxDdsSide));
  }
  return header;
}

}  // namespace

std::string imageToDds(const Image& image, DdsHeader header) {
  ddsFormatOf(image);
  if (image.layers > 1 && (image.depth > 1 || header == DdsHeader::kLegacy))
    throw Refusal("DDS: this header has no place for an array of textures");
  if (image.width > kMaxDdsSide || image.height > kMaxDdsSide || image.depth > kMaxSlices ||
      image.layers > kMaxSlices)
    throw Refusal(fmt::format("DDS: {} x {} x {} texels are more than Direct3D takes", image.width,
                              image.height, image.depth));
  std::string out = headerOf(image, header, 1);
  appendValues(out, image.values, image.precision);
  return out;
}

std::string mipsToDds(const std::vector<Image>& levels) {
  if (!isMipChain(levels) || levels[0].width > kMaxDdsSide || levels[0].height > kMaxDdsSide)
    throw std::invalid_argument("DDS: the levels are no chain of mip maps that Direct3D takes");
  std::string out = headerOf(levels[0], DdsHeader::kDx10, levels.size());
  for (const Image& level : levels) appendValues(out, level.values, level.precision);
  return out;
}

bool isDds(std::string_view bytes) {
  return bytes.starts_with(kDdsMagic);
}

Image parseDds(std::string_view bytes, const std::string& name) {
  ParsedHeader header = parseDdsHeader(bytes, name);
  if (header.levels > 1) throw InputError(name + ": DDS with mip maps; a table has none");
  Image& image = header.image;
  const std::size_t present = bytes.size() - header.size;
  // 2^56 at most: no overflow
  if (image.texels() > present || image.texels() * image.components * image.bytesPerValue() != present) {
    throw InputError(fmt::format("{}: {} x {} x {} texels, {} layers do not fit the {} bytes of data", name,
                                 image.width, image.height, image.depth, image.layers, present));
  }
  image.values = readValues(bytes.substr(header.size), image.precision);
  return std::move(image);
}

std::vector<Image> parseDdsMips(std::string_view bytes, const std::string& name) {
  const ParsedHeader header = parseDdsHeader(bytes, name);
  const Image& finest = header.image;
  if (finest.depth > 1 || finest.layers > 1 || finest.components != 4)
    throw InputError(name + ": DDS: need one RGBA texture of two dimensions");
  if (header.levels > kMaxLevels)
    throw InputError(fmt::format("{}: DDS with {} mip maps", name, header.levels));
  std::string_view rest = bytes.substr(header.size);
  std::vector<Image> levels = mipLevels(finest, header.levels);
  for (Image& level : levels) {
    const std::size_t size = level.texels() * level.components * level.bytesPerValue();
    if (size > rest.size()) throw InputError(name + ": DDS cut off, or larger than its header claims");
    level.values = readValues(rest.substr(0, size), level.precision);
    rest.remove_prefix(size);
  }
  if (!rest.empty() || !isMipChain(levels))
    throw InputError(name + ": DDS: the levels do not fit its length and size");
  return levels;
}

}  // namespace ltcfit
