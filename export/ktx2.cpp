#include "export/ktx2.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "base/refusal.h"
#include "export/atomic_file.h"
#include "export/little_endian.h"
#include "export/mip_chain.h"

// KTX File KtxFormat Specification 2.0, revision 4: identifier, header, index, level index, data format
// descriptor, key/value data, levels.
namespace ltcfit {
namespace {

constexpr std::string_view kIdentifier("\xABKTX 20\xBB\r\n\x1A\n", 12);
constexpr std::size_t kHeaderSize = 80;  // identifier, header and index
constexpr std::size_t kLevelIndexSize = 24;
constexpr std::uint32_t kZstd = 2;
// A frame of zstd holds at most this many bytes for one of its own, tables of zeros apart: a table never
// comes near it. Next to kMaxImageNumbers it bounds what a damaged length can make us allocate.
constexpr std::size_t kMaxRatio = 256;
// That of zstd itself, a block of 128 KiB of one byte in 4 bytes: pictures may be black.
constexpr std::size_t kMaxPictureRatio = 32768;
constexpr std::size_t kMaxKtxSide = 16384;
constexpr int kZstdLevel = 19;  // smallest output for 64 KiB; takes 20 ms
constexpr int kZstdPictureLevel = 9;

struct KtxFormat {
  std::uint32_t vkFormat;
  std::size_t components;
  Precision precision;
};
constexpr std::array<KtxFormat, 6> kKtxFormats{{{76, 1, Precision::kHalf},
                                                {83, 2, Precision::kHalf},
                                                {97, 4, Precision::kHalf},
                                                {100, 1, Precision::kFloat},
                                                {103, 2, Precision::kFloat},
                                                {109, 4, Precision::kFloat}}};

// Khronos Data KtxFormat Specification 1.4, basic descriptor block.
std::string dataFormatDescriptor(const Image& image) {
  const auto bits = static_cast<std::uint32_t>(8 * image.bytesPerValue());
  const auto samples = static_cast<std::uint32_t>(image.components);
  const std::uint32_t blockSize = 24 + 16 * samples;
  std::string out;
  append(out, blockSize + 4);
  append(out, std::uint32_t{0});         // vendor Khronos, descriptor type basic
  append(out, 2u | blockSize << 16);     // version 1.3 and later
  append(out, 1u | 1u << 8 | 1u << 16);  // model RGBSDA, primaries BT.709, transfer linear, no flags
  append(out, std::uint32_t{0});         // a block of one texel
  append(out, samples * bits / 8);       // bytes of plane 0, kept under supercompression (rev. 4)
  append(out, std::uint32_t{0});
  constexpr std::array<std::uint32_t, 4> kChannels{0, 1, 2, 15};  // red, green, blue, alpha
  for (std::uint32_t s = 0; s < samples; ++s) {
    append(out, s * bits | (bits - 1) << 16 | (0xC0u | kChannels[s]) << 24);  // float, signed
    append(out, std::uint32_t{0});
    append(out, std::uint32_t{0xBF800000});  // -1.0f
    append(out, std::uint32_t{0x3F800000});  // 1.0f
  }
  return out;
}

std::string keyValueData(std::vector<std::pair<std::string, std::string>> pairs) {
  std::sort(pairs.begin(), pairs.end());
  std::string out;
  for (const auto& [key, value] : pairs) {
    append(out, static_cast<std::uint32_t>(key.size() + value.size() + 2));
    out += key + '\0' + value + '\0';
    out.append((4 - out.size() % 4) % 4, '\0');
  }
  return out;
}

std::string deflate(const std::string& level, int effort) {
  std::string out(ZSTD_compressBound(level.size()), '\0');
  const std::size_t size = ZSTD_compress(out.data(), out.size(), level.data(), level.size(), effort);
  if (ZSTD_isError(size) != 0) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

[[noreturn]] void refuseZstd(const std::string& name) {
  throw InputError(name + ": damaged zstd data, or of another length than the header claims");
}

std::string inflate(std::string_view level, std::size_t size, std::size_t maxRatio, const std::string& name) {
  if (size / maxRatio > level.size())
    throw InputError(fmt::format("{}: claims {} bytes in {} compressed ones", name, size, level.size()));
  // what the frame says itself, before anything is allocated for the header's claim
  const unsigned long long told = ZSTD_getFrameContentSize(level.data(), level.size());
  const bool isOne = ZSTD_findFrameCompressedSize(level.data(), level.size()) == level.size();
  if (told == ZSTD_CONTENTSIZE_ERROR) refuseZstd(name);
  if (told != ZSTD_CONTENTSIZE_UNKNOWN && (told > size || (told < size && isOne))) {
    throw InputError(
        fmt::format("{}: a zstd frame of {} bytes where the KTX2 header claims {}", name, told, size));
  }
  std::string out(size, '\0');
  const std::size_t got = ZSTD_decompress(out.data(), out.size(), level.data(), level.size());
  if (ZSTD_isError(got) != 0 || got != size) refuseZstd(name);
  return out;
}

std::vector<std::pair<std::string, std::string>> parseKeyValues(std::string_view data,
                                                                const std::string& name) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (std::size_t at = 0; at + 4 <= data.size();) {
    const std::size_t length = readAt<std::uint32_t>(data, at);
    at += 4;
    if (length > data.size() - at) throw InputError(name + ": KTX2 key/value data cut off");
    const std::string_view pair = data.substr(at, length);
    const std::size_t zero = pair.find('\0');
    if (zero == std::string_view::npos) throw InputError(name + ": KTX2 key without an end");
    std::string_view value = pair.substr(zero + 1);
    if (value.ends_with('\0')) value.remove_suffix(1);
    pairs.emplace_back(pair.substr(0, zero), value);
    at += length;
    at += std::min((4 - at % 4) % 4, data.size() - at);
  }
  return pairs;
}

// A part of the file that its index points to.
std::string_view part(std::string_view bytes, std::uint64_t offset, std::uint64_t length, const char* what,
                      const std::string& name) {
  if (offset > bytes.size() || length > bytes.size() - offset) {
    throw InputError(fmt::format("{}: KTX2 {}: {} bytes at {} are not in the file of {}", name, what, length,
                                 offset, bytes.size()));
  }
  return bytes.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

const KtxFormat* ktxFormatOf(const Image& image) {
  for (const KtxFormat& f : kKtxFormats) {
    if (f.components == image.components && f.precision == image.precision) return &f;
  }
  return nullptr;
}

// `images` are the levels, from the finest on.
std::string toKtx2(std::span<const Image> images,
                   const std::vector<std::pair<std::string, std::string>>& pairs, Ktx2Compression compression,
                   int effort) {
  const Image& image = images[0];
  const bool isPacked = compression == Ktx2Compression::kZstd;
  const std::string descriptor = dataFormatDescriptor(image);
  const std::string keyValues = keyValueData(pairs);
  const std::size_t descriptorAt = kHeaderSize + kLevelIndexSize * images.size();
  const std::size_t keyValuesAt = descriptorAt + descriptor.size();
  // an uncompressed level starts at a multiple of the texel size and of 4
  const std::size_t alignment =
      isPacked ? 1 : std::max<std::size_t>(4, image.components * image.bytesPerValue());
  const auto u32 = [](std::size_t v) { return static_cast<std::uint32_t>(v); };

  std::string out(kIdentifier);
  append(out, ktxFormatOf(image)->vkFormat);
  append(out, u32(image.bytesPerValue()));  // typeSize
  append(out, u32(image.width));
  append(out, u32(image.height));
  append(out, u32(image.depth > 1 ? image.depth : 0));
  append(out, u32(image.layers > 1 ? image.layers : 0));
  append(out, std::uint32_t{1});  // faces
  append(out, u32(images.size()));
  append(out, isPacked ? kZstd : 0u);
  append(out, u32(descriptorAt));
  append(out, u32(descriptor.size()));
  append(out, u32(keyValues.empty() ? 0 : keyValuesAt));
  append(out, u32(keyValues.size()));
  append(out, std::uint64_t{0});  // no supercompression global data
  append(out, std::uint64_t{0});

  // the index runs from the finest level, the data from the coarsest
  std::vector<std::array<std::uint64_t, 3>> index(images.size());
  std::string data;
  const std::size_t dataAt = keyValuesAt + keyValues.size();
  for (std::size_t l = images.size(); l-- > 0;) {
    std::string level;
    appendValues(level, images[l].values, images[l].precision);
    const std::size_t uncompressed = level.size();
    if (isPacked) level = deflate(level, effort);
    data.append((alignment - (dataAt + data.size()) % alignment) % alignment, '\0');
    index[l] = {dataAt + data.size(), level.size(), uncompressed};
    data += level;
  }
  for (const auto& entry : index)
    for (const std::uint64_t number : entry) append(out, number);
  return out + descriptor + keyValues + data;
}

// What the header says: the finest level, without its values, and how many levels there are.
struct KtxHeader {
  Image image;
  std::size_t levels = 1;
  bool isPacked = false;
  std::vector<std::pair<std::string, std::string>> keyValues;
};

KtxHeader parseKtxHeader(std::string_view bytes, const std::string& name) {
  if (!isKtx2(bytes) || bytes.size() < kHeaderSize + kLevelIndexSize)
    throw InputError(name + ": not a KTX2 file, or cut off in its header");
  const auto field = [&](std::size_t offset) { return readAt<std::uint32_t>(bytes, offset); };
  KtxHeader header;
  Image& image = header.image;
  bool known = false;
  for (const KtxFormat& f : kKtxFormats) {
    if (field(12) != f.vkFormat) continue;
    image.components = f.components;
    image.precision = f.precision;
    known = true;
  }
  if (!known)
    throw InputError(
        fmt::format("{}: KTX2 vkFormat {} is not known (R, RG, RGBA, half or float)", name, field(12)));
  image.width = field(20);
  image.height = field(24);
  image.depth = std::max(1u, field(28));
  image.layers = std::max(1u, field(32));
  if (field(36) != 1) throw InputError(fmt::format("{}: KTX2 with {} faces; need one", name, field(36)));
  header.levels = std::max(1u, field(40));
  const std::uint32_t scheme = field(44);
  if (scheme != 0 && scheme != kZstd)
    throw InputError(fmt::format("{}: KTX2 supercompression {} is not known (0 none, 2 zstd)", name, scheme));
  header.isPacked = scheme == kZstd;
  for (std::size_t side : {image.width, image.height, image.depth, image.layers}) {
    if (side == 0 || side > kMaxKtxSide)
      throw InputError(fmt::format("{}: KTX2 header: a size of {}; need 1 to {}", name, side, kMaxKtxSide));
  }
  // 2^58 at most: no overflow
  if (image.texels() * image.components > kMaxImageNumbers)
    throw InputError(fmt::format(
        "{}: KTX2 header: {} x {} x {} texels, {} layers of {} numbers; need {} numbers at most", name,
        image.width, image.height, image.depth, image.layers, image.components, kMaxImageNumbers));
  header.keyValues = parseKeyValues(part(bytes, field(56), field(60), "key/value data", name), name);
  return header;
}

// The values of level `l`, whose size `image` has.
std::vector<float> parseLevel(std::string_view bytes, std::size_t l, const Image& image, bool isPacked,
                              std::size_t maxRatio, const std::string& name) {
  const std::size_t at = kHeaderSize + kLevelIndexSize * l;
  const std::string_view level =
      part(bytes, readAt<std::uint64_t>(bytes, at), readAt<std::uint64_t>(bytes, at + 8), "level", name);
  const std::size_t size = image.texels() * image.components * image.bytesPerValue();
  if (readAt<std::uint64_t>(bytes, at + 16) != size || (!isPacked && level.size() != size)) {
    throw InputError(fmt::format("{}: {} x {} x {} texels, {} layers do not fit the length of the level",
                                 name, image.width, image.height, image.depth, image.layers));
  }
  return isPacked ? readValues(inflate(level, size, maxRatio, name), image.precision)
                  : readValues(level, image.precision);
}

}  // namespace

std::string imageToKtx2(const Ktx2File& file, Ktx2Compression compression) {
  const Image& image = file.image;
  if (ktxFormatOf(image) == nullptr) throw Refusal("KTX2: need 1, 2 or 4 components a texel");
  if (image.layers > 1 && image.depth > 1) throw Refusal("KTX2: no arrays of volumes");
  return toKtx2({&image, 1}, file.keyValues, compression, kZstdLevel);
}

std::string mipsToKtx2(const Ktx2Mips& file, Ktx2Compression compression) {
  if (!isMipChain(file.levels)) throw std::invalid_argument("KTX2: the levels are no chain of mip maps");
  return toKtx2(file.levels, file.keyValues, compression, kZstdPictureLevel);
}

bool isKtx2(std::string_view bytes) {
  return bytes.starts_with(kIdentifier);
}

Ktx2File parseKtx2(std::string_view bytes, const std::string& name) {
  KtxHeader header = parseKtxHeader(bytes, name);
  if (header.levels > 1)
    throw InputError(fmt::format("{}: KTX2 with {} levels; a table has one", name, header.levels));
  Ktx2File file{std::move(header.image), std::move(header.keyValues)};
  file.image.values = parseLevel(bytes, 0, file.image, header.isPacked, kMaxRatio, name);
  return file;
}

Ktx2Mips parseKtx2Mips(std::string_view bytes, const std::string& name) {
  KtxHeader header = parseKtxHeader(bytes, name);
  const Image& finest = header.image;
  if (finest.depth > 1 || finest.layers > 1 || finest.components != 4)
    throw InputError(name + ": KTX2: need one RGBA texture of two dimensions");
  if (header.levels > kMaxLevels || bytes.size() < kHeaderSize + kLevelIndexSize * header.levels)
    throw InputError(fmt::format("{}: KTX2 with {} levels, or cut off in their index", name, header.levels));
  Ktx2Mips file{mipLevels(finest, header.levels), std::move(header.keyValues)};
  for (std::size_t l = 0; l < header.levels; ++l)
    file.levels[l].values = parseLevel(bytes, l, file.levels[l], header.isPacked, kMaxPictureRatio, name);
  if (!isMipChain(file.levels)) throw InputError(name + ": KTX2: more levels than its size has");
  return file;
}

}  // namespace ltcfit
