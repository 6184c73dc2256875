#include "export/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "export/atomic_file.h"
#include "export/little_endian.h"

namespace ltcfit {
namespace {

// The lossless compressions, in the order of their codes. A table is not for the lossy ones.
struct Compression {
  std::int64_t lines;  // of a block
  std::int64_t ratio;  // data to file at most: 1032 is deflate's limit, PIZ' is lower
};
constexpr std::array<Compression, 5> kCompressions{{{1, 1}, {1, 1032}, {1, 1032}, {16, 1032}, {32, 1032}}};

// Attribute types and their lengths. OpenEXR reads that many bytes whatever length the file tells, and goes
// on with what follows them as the next attribute.
struct AttributeSize {
  std::size_t size;
  std::string_view types;
};
constexpr std::array<AttributeSize, 13> kAttributeSizes{{{1, " compression deepImageState envmap lineOrder "},
                                                         {4, " float int "},
                                                         {8, " double rational timecode v2f v2i "},
                                                         {9, " tiledesc "},
                                                         {12, " v3f v3i "},
                                                         {16, " box2f box2i v2d "},
                                                         {24, " v3d "},
                                                         {28, " keycode "},
                                                         {32, " chromaticities "},
                                                         {36, " m33f "},
                                                         {64, " m44f "},
                                                         {72, " m33d "},
                                                         {128, " m44d "}}};
// Types of which no table has any: they hold lengths of their own, or belong to other kinds of files.
constexpr std::array<std::string_view, 2> kRefusedTypes{"idmanifest", "stringvector"};

// The parts of a header that decide how much OpenEXR allocates, read before it sees the file: of its own it
// takes the lengths of attributes, tiles and blocks for granted.
class HeaderCheck {
 public:
  HeaderCheck(std::string_view bytes, std::string name, ExrKind kind)
      : bytes_(bytes), name_(std::move(name)), tiled_(kind == ExrKind::kMips) {}

  void run() {
    if (bytes_.size() < 8) cutOff();
    const auto version = readAt<std::uint32_t>(bytes_, 4);
    if ((version & ~kLongNames) != (tiled_ ? 2 | kTiled : 2)) {
      refuseExr(name_, tiled_ ? "not tiled, deep, multi-part or of another version; need mip maps"
                              : "tiled, deep, multi-part or of another version; need scan lines");
    }
    std::string_view window;
    std::string_view compression;
    std::string_view channels;
    std::string_view tiles;
    for (at_ = 8;;) {
      const std::string_view key = string();
      if (key.empty()) break;
      const std::string_view type = string();
      const auto length = readAt<std::uint32_t>(take(4), 0);
      const std::string_view value = take(length);
      if (key == "dataWindow") keep(window, value);
      if (key == "compression") keep(compression, value);
      if (key == "channels") keep(channels, value);
      if (key == "tiles") keep(tiles, value);
      // OpenEXR reads on until the list ends: only the one that is checked
      if ((key == "channels") != (type == "chlist")) refuseExr(name_, "a list of channels in a wrong place");
      if ((key == "tiles") != (type == "tiledesc"))
        refuseExr(name_, "a description of tiles in a wrong place");
      if (key == "type" && value != (tiled_ ? "tiledimage" : "scanlineimage"))
        refuseExr(name_, "not an image of that type");
      checkAttribute(key, type, length);
    }
    if (window.size() != 16 || compression.size() != 1 || channels.empty())
      refuseExr(name_, "no data window, compression or channels");
    if (tiled_ != !tiles.empty()) refuseExr(name_, "tiles where none are to be, or none");
    checkSize(window, static_cast<unsigned char>(compression[0]), bytesOfPixel(channels), tiles);
  }

 private:
  static constexpr std::uint32_t kTiled = 0x200;
  static constexpr std::uint32_t kLongNames = 0x400;

  void keep(std::string_view& kept, std::string_view value) const {
    if (kept.data() != nullptr) refuseExr(name_, "an attribute twice");
    kept = value;
  }
  [[noreturn]] void cutOff() const { refuseExr(name_, "cut off in its header"); }
  std::string_view take(std::size_t length) {
    if (length > bytes_.size() - at_) cutOff();
    at_ += length;
    return bytes_.substr(at_ - length, length);
  }
  // up to a zero
  std::string_view string() {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string_view::npos) cutOff();
    const std::string_view text = take(end - at_);
    ++at_;
    return text;
  }
  void checkAttribute(std::string_view key, std::string_view type, std::size_t length) const {
    bool fits = type != "floatvector" || length % 4 == 0;
    for (const AttributeSize& entry : kAttributeSizes) {
      if (entry.types.find(fmt::format(" {} ", type)) != std::string_view::npos) fits = length == entry.size;
    }
    if (!fits) refuseExr(name_, fmt::format("attribute '{}': {} bytes are no {}", key, length, type));
    if (std::find(kRefusedTypes.begin(), kRefusedTypes.end(), type) != kRefusedTypes.end())
      refuseExr(name_, fmt::format("attribute '{}' of type '{}', which no table has", key, type));
  }
  // Of all channels.
  std::int64_t bytesOfPixel(std::string_view list) const {
    std::int64_t size = 0;
    std::size_t at = 0;
    while (at < list.size() && list[at] != '\0') {
      // name, type, 4 bytes, sampling of x and y
      const std::size_t end = list.find('\0', at);
      if (end == std::string_view::npos || list.size() - end < 17) cutOff();
      const auto type = readAt<std::uint32_t>(list, end + 1);
      if ((type != 1 && type != 2) || readAt<std::uint32_t>(list, end + 9) != 1 ||
          readAt<std::uint32_t>(list, end + 13) != 1) {
        refuseExr(name_, fmt::format("channel '{}' is not one of numbers at every pixel",
                                     list.substr(at, end - at)));
      }
      size += type == 1 ? 2 : 4;
      at = end + 17;
    }
    if (size == 0 || at + 1 != list.size()) refuseExr(name_, "no channels, or something behind them");
    return size;
  }
  void checkSize(std::string_view window, std::size_t code, std::int64_t pixel,
                 std::string_view tiles) const {
    const auto side = [&](std::size_t axis) {
      return std::int64_t{readAt<std::int32_t>(window, 8 + axis)} - readAt<std::int32_t>(window, axis) + 1;
    };
    const std::int64_t width = side(0);
    const std::int64_t height = side(4);
    if (width < 1 || height < 1 || width > kMaxExrSide || height > kMaxExrSide)
      refuseExr(name_, "a size that no table has");
    if (code >= kCompressions.size())
      refuseExr(name_, fmt::format("compression {}: lossy, which a table must not be, or unknown", code));
    const Compression& c = kCompressions[code];
    if (!tiles.empty()) return checkTiles(tiles, width, height, pixel, c.ratio);
    // a block is allocated whole, be the image lower or not; and the table of blocks has 8 bytes for each
    const auto length = static_cast<std::int64_t>(bytes_.size());
    if (width * pixel * std::max(height, c.lines) > length * c.ratio ||
        (height + c.lines - 1) / c.lines * 8 > length)
      refuseExr(name_, "more pixels than its length can hold");
  }

  // A tile is allocated whole, and the table of tiles has 8 bytes for each.
  void checkTiles(std::string_view tiles, std::int64_t width, std::int64_t height, std::int64_t pixel,
                  std::int64_t ratio) const {
    constexpr char kMipMapRoundDown = 1;
    const std::int64_t across = readAt<std::uint32_t>(tiles, 0);
    const std::int64_t down = readAt<std::uint32_t>(tiles, 4);
    if (across < 1 || down < 1 || across > kMaxExrSide || down > kMaxExrSide || tiles[8] != kMipMapRoundDown)
      refuseExr(name_, "tiles of another kind than mip maps rounded down");
    const auto length = static_cast<std::int64_t>(bytes_.size());
    std::int64_t count = 0;
    for (std::int64_t w = width, h = height;; w /= 2, h /= 2) {
      w = std::max<std::int64_t>(w, 1);
      h = std::max<std::int64_t>(h, 1);
      count += ((w + across - 1) / across) * ((h + down - 1) / down);
      if (w == 1 && h == 1) break;
    }
    if (width * height * pixel > length * ratio || across * down * pixel > length * ratio ||
        count * 8 > length)
      refuseExr(name_, "more pixels than its length can hold");
  }

  std::string_view bytes_;
  std::string name_;
  bool tiled_;
  std::size_t at_ = 0;
};

}  // namespace

void refuseExr(const std::string& name, const std::string& what) {
  throw InputError(name + ": EXR: " + what);
}

void checkExrHeader(std::string_view bytes, const std::string& name, ExrKind kind) {
  HeaderCheck(bytes, name, kind).run();
}

}  // namespace ltcfit
