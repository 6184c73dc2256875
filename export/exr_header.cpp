#include "export/exr_header.h"

#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "export/atomic_file.h"
#include "export/image.h"
#include "export/little_endian.h"
#include "export/picture.h"

namespace ltcfit {
namespace {

// In the order of their codes: none, RLE, ZIPS, ZIP, PIZ; and the lossy ones, which a table is not for:
// PXR24, B44, B44A, DWAA, DWAB.
struct Compression {
  std::int64_t lines;  // of a block
  // Data to file at most: 1032 is deflate's limit, PIZ' is lower. PXR24 deflates 3 bytes of a float's 4; B44A
  // stores 16 halves in 3 bytes; DWA deflates the 4 bytes that 64 floats need at least.
  std::int64_t ratio;
};
constexpr std::array<Compression, 10> kCompressions{{{1, 1},
                                                     {1, 1032},
                                                     {1, 1032},
                                                     {16, 1032},
                                                     {32, 1032},
                                                     {16, 1376},
                                                     {32, 11},
                                                     {32, 11},
                                                     {32, 66048},
                                                     {256, 66048}}};
constexpr std::size_t kLossless = 5;
constexpr std::size_t kNamedChannels = 16;  // in a message

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
// Types that are not read: they hold lengths of their own, or belong to other kinds of files.
constexpr std::array<std::string_view, 2> kRefusedTypes{"idmanifest", "stringvector"};

// The parts of a header that decide how much OpenEXR allocates, read before it sees the file: of its own it
// takes the lengths of attributes, tiles and blocks for granted.
class HeaderCheck {
 public:
  HeaderCheck(std::string_view bytes, std::string name, ExrKind kind)
      : bytes_(bytes), name_(std::move(name)), tiled_(kind == ExrKind::kMips), kind_(kind) {}

  void run() {
    if (bytes_.size() < 8) cutOff();
    const auto version = readAt<std::uint32_t>(bytes_, 4);
    checkVersion(version & ~kLongNames);
    std::string_view window;
    std::string_view display;
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
      if (key == "displayWindow") keep(display, value);
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
    const std::vector<Channel> list = channelsOf(channels);
    if (kind_ == ExrKind::kPicture) {
      checkPictureChannels(list);
      if (display != window) {
        refuseExr(name_,
                  "the data window is not the display window, which a picture is; crop or extend it, e.g. by "
                  "`oiiotool in.exr --croptofull -o out.exr`");
      }
    }
    checkSize(window, static_cast<unsigned char>(compression[0]), bytesOfPixel(list), tiles);
  }

 private:
  static constexpr std::uint32_t kTiled = 0x200;
  static constexpr std::uint32_t kLongNames = 0x400;
  static constexpr std::uint32_t kMultiPart = 0x1000;

  struct Channel {
    std::string_view name;
    std::uint32_t type;  // 0 integers, 1 halves, 2 floats
    bool everyPixel;     // not subsampled
  };

  const char* thing() const {
    return kind_ == ExrKind::kPicture ? "picture" : kind_ == ExrKind::kTable ? "table" : "texture";
  }
  void checkVersion(std::uint32_t version) const {
    if (version == (tiled_ ? 2 | kTiled : 2)) return;
    if (tiled_) refuseExr(name_, "not tiled, deep, multi-part or of another version; need mip maps");
    if (kind_ == ExrKind::kPicture && version == (2 | kTiled)) {
      refuseExr(
          name_,
          "a tiled picture; need scan lines: convert it, e.g. by `oiiotool in.exr --scanline -o out.exr`");
    }
    if (kind_ == ExrKind::kPicture && version == (2 | kMultiPart)) {
      refuseExr(name_,
                "several parts; need one of scan lines: convert it, e.g. by `oiiotool in.exr --subimage 0 "
                "--scanline -o out.exr`");
    }
    refuseExr(name_, "tiled, deep, multi-part or of another version; need scan lines");
  }

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
      refuseExr(name_, fmt::format("attribute '{}' of type '{}', which no {} has", key, type, thing()));
  }
  std::vector<Channel> channelsOf(std::string_view list) const {
    std::vector<Channel> out;
    std::size_t at = 0;
    while (at < list.size() && list[at] != '\0') {
      // name, type, 4 bytes, sampling of x and y
      const std::size_t end = list.find('\0', at);
      if (end == std::string_view::npos || list.size() - end < 17) cutOff();
      out.push_back(
          {list.substr(at, end - at), readAt<std::uint32_t>(list, end + 1),
           readAt<std::uint32_t>(list, end + 9) == 1 && readAt<std::uint32_t>(list, end + 13) == 1});
      at = end + 17;
    }
    if (out.empty() || at + 1 != list.size()) refuseExr(name_, "no channels, or something behind them");
    return out;
  }
  // Y is grey alone; with X and Z or with chroma it is not.
  void checkPictureChannels(const std::vector<Channel>& list) const {
    const auto has = [&](std::string_view channel) {
      return std::any_of(list.begin(), list.end(), [&](const Channel& c) { return c.name == channel; });
    };
    if (has("R") && has("G") && has("B")) return;
    const bool chroma = has("RY") || has("BY");
    const bool tristimulus = has("X") && has("Y");
    if (has("Y") && !chroma && !tristimulus && !has("R") && !has("G") && !has("B")) return;
    std::string names;
    for (std::size_t i = 0; i < std::min(list.size(), kNamedChannels); ++i)
      names += fmt::format("{}{}", i == 0 ? "" : ", ", list[i].name);
    if (list.size() > kNamedChannels) names += ", ...";
    refuseExr(name_, fmt::format("need channels R, G and B, or Y alone; it has {}. {}", names,
                                 chroma        ? "Luminance and chroma: write it anew as RGB"
                                 : tristimulus ? "CIE X, Y and Z: convert it to linear RGB first"
                                               : "Convert it, e.g. by `oiiotool in.exr --ch R,G,B -o "
                                                 "out.exr`, with R=NAME for a channel of another name"));
  }
  // Of all channels.
  std::int64_t bytesOfPixel(const std::vector<Channel>& list) const {
    std::int64_t size = 0;
    for (const Channel& c : list) {
      const bool passedOver =
          kind_ == ExrKind::kPicture && c.name != "R" && c.name != "G" && c.name != "B" && c.name != "Y";
      if (!c.everyPixel || !(c.type == 1 || c.type == 2 || (c.type == 0 && passedOver))) {
        refuseExr(name_, fmt::format("channel '{}' is not one of numbers at every pixel{}", c.name,
                                     passedOver ? "; leave it out, e.g. by `oiiotool in.exr --ch R,G,B -o "
                                                  "out.exr`"
                                                : ""));
      }
      size += c.type == 1 ? 2 : 4;
    }
    return size;
  }
  void checkSize(std::string_view window, std::size_t code, std::int64_t pixel,
                 std::string_view tiles) const {
    const auto side = [&](std::size_t axis) {
      return std::int64_t{readAt<std::int32_t>(window, 8 + axis)} - readAt<std::int32_t>(window, axis) + 1;
    };
    const std::int64_t width = side(0);
    const std::int64_t height = side(4);
    const std::int64_t largest =
        kind_ == ExrKind::kPicture ? static_cast<std::int64_t>(kMaxPictureSide) : kMaxExrSide;
    if (width < 1 || height < 1 || width > largest || height > largest)
      refuseExr(name_, fmt::format("{} x {} pixels; need 1 to {}", width, height, largest));
    if (code >= kCompressions.size()) refuseExr(name_, fmt::format("compression {} is unknown", code));
    if (code >= kLossless && kind_ != ExrKind::kPicture)
      refuseExr(name_, fmt::format("compression {} is lossy, which a {} must not be", code, thing()));
    const Compression& c = kCompressions[code];
    if (!tiles.empty()) return checkTiles(tiles, width, height, pixel, c.ratio);
    // a block is allocated whole, be the image lower or not; and the table of blocks has 8 bytes for each
    const auto length = static_cast<std::int64_t>(bytes_.size());
    if (width * pixel * std::max(height, c.lines) > length * c.ratio ||
        (height + c.lines - 1) / c.lines * 8 > length)
      refuseExr(name_, "more pixels than its length can hold");
    checkAllocation(width, kind_ == ExrKind::kPicture ? c.lines : std::max(height, c.lines), pixel);
  }

  // What a file as long as its claim could make us allocate: an image with all channels; of a picture, whose
  // other channels are passed over, a block of lines.
  void checkAllocation(std::int64_t width, std::int64_t lines, std::int64_t pixel) const {
    constexpr auto kMostBytes = static_cast<std::int64_t>(kMaxImageNumbers * sizeof(float));
    if (width * lines * pixel > kMostBytes)
      refuseExr(name_, fmt::format("{} x {} pixels of {} bytes are more than the {} bytes that it may take",
                                   width, lines, pixel, kMostBytes));
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
    checkAllocation(width, height, pixel);
    checkAllocation(across, down, pixel);
  }

  std::string_view bytes_;
  std::string name_;
  bool tiled_;
  ExrKind kind_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<std::pair<std::string, std::string>> exrTexts(const OPENEXR_IMF_NAMESPACE::Header& header) {
  std::vector<std::pair<std::string, std::string>> out;
  for (auto a = header.begin(); a != header.end(); ++a) {
    if (const auto* text = dynamic_cast<const OPENEXR_IMF_NAMESPACE::StringAttribute*>(&a.attribute()))
      out.emplace_back(a.name(), text->value());
  }
  return out;
}

void refuseExr(const std::string& name, const std::string& what) {
  throw InputError(name + ": EXR: " + what);
}

void checkExrHeader(std::string_view bytes, const std::string& name, ExrKind kind) {
  HeaderCheck(bytes, name, kind).run();
}

}  // namespace ltcfit
