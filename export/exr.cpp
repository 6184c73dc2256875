#include "export/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "export/atomic_file.h"
#include "export/little_endian.h"

namespace ltcfit {
namespace {

constexpr std::string_view kMagic("\x76\x2F\x31\x01", 4);
constexpr int kMaxSide = 16384;

// The lossless compressions, in the order of their codes. A table is not for the lossy ones.
struct Compression {
  std::int64_t lines;  // of a block
  std::int64_t ratio;  // data to file at most: 1032 is deflate's limit, PIZ' is lower
};
constexpr std::array<Compression, 5> kCompressions{{{1, 1}, {1, 1032}, {1, 1032}, {16, 1032}, {32, 1032}}};

class StringOutput : public OPENEXR_IMF_NAMESPACE::OStream {
 public:
  StringOutput() : OStream("memory") {}
  void write(const char* bytes, int count) override {
    const auto n = static_cast<std::size_t>(count);
    if (bytes_.size() < at_ + n) bytes_.resize(at_ + n);
    std::memcpy(bytes_.data() + at_, bytes, n);
    at_ += n;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

class StringInput : public OPENEXR_IMF_NAMESPACE::IStream {
 public:
  explicit StringInput(std::string_view bytes) : IStream("memory"), bytes_(bytes) {}
  bool read(char* out, int count) override {
    const auto n = static_cast<std::size_t>(count);
    if (count < 0 || at_ > bytes_.size() || n > bytes_.size() - at_) throw std::runtime_error("cut off");
    std::memcpy(out, bytes_.data() + at_, n);
    at_ += n;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw InputError(name + ": EXR: " + what);
}

// Attribute types and their lengths. OpenEXR reads that many bytes whatever length the file tells, and goes
// on with what follows them as the next attribute.
struct AttributeSize {
  std::size_t size;
  std::string_view types;
};
constexpr std::array<AttributeSize, 12> kAttributeSizes{{{1, " compression deepImageState envmap lineOrder "},
                                                         {4, " float int "},
                                                         {8, " double rational timecode v2f v2i "},
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
constexpr std::array<std::string_view, 3> kRefusedTypes{"idmanifest", "stringvector", "tiledesc"};

// The parts of a header that decide how much OpenEXR allocates, read before it sees the file: of its own it
// takes the lengths of attributes, tiles and blocks for granted.
class HeaderCheck {
 public:
  HeaderCheck(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  void run() {
    if (bytes_.size() < 8) cutOff();
    const auto version = readAt<std::uint32_t>(bytes_, 4);
    if ((version & ~kLongNames) != 2)
      refuse(name_, "tiled, deep, multi-part or of another version; need scan lines");
    std::string_view window;
    std::string_view compression;
    std::string_view channels;
    for (at_ = 8;;) {
      const std::string_view key = string();
      if (key.empty()) break;
      const std::string_view type = string();
      const auto length = readAt<std::uint32_t>(take(4), 0);
      const std::string_view value = take(length);
      if (key == "dataWindow") keep(window, value);
      if (key == "compression") keep(compression, value);
      if (key == "channels") keep(channels, value);
      // OpenEXR reads on until the list ends: only the one that is checked
      if ((key == "channels") != (type == "chlist")) refuse(name_, "a list of channels in a wrong place");
      if (key == "type" && value != "scanlineimage") refuse(name_, "not an image of scan lines");
      checkAttribute(key, type, length);
    }
    if (window.size() != 16 || compression.size() != 1 || channels.empty())
      refuse(name_, "no data window, compression or channels");
    checkSize(window, static_cast<unsigned char>(compression[0]), bytesOfPixel(channels));
  }

 private:
  static constexpr std::uint32_t kLongNames = 0x400;

  void keep(std::string_view& kept, std::string_view value) const {
    if (kept.data() != nullptr) refuse(name_, "an attribute twice");
    kept = value;
  }
  [[noreturn]] void cutOff() const { refuse(name_, "cut off in its header"); }
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
    if (!fits) refuse(name_, fmt::format("attribute '{}': {} bytes are no {}", key, length, type));
    if (std::find(kRefusedTypes.begin(), kRefusedTypes.end(), type) != kRefusedTypes.end())
      refuse(name_, fmt::format("attribute '{}' of type '{}', which no table has", key, type));
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
        refuse(name_,
               fmt::format("channel '{}' is not one of numbers at every pixel", list.substr(at, end - at)));
      }
      size += type == 1 ? 2 : 4;
      at = end + 17;
    }
    if (size == 0 || at + 1 != list.size()) refuse(name_, "no channels, or something behind them");
    return size;
  }
  void checkSize(std::string_view window, std::size_t code, std::int64_t pixel) const {
    const auto side = [&](std::size_t axis) {
      return std::int64_t{readAt<std::int32_t>(window, 8 + axis)} - readAt<std::int32_t>(window, axis) + 1;
    };
    const std::int64_t width = side(0);
    const std::int64_t height = side(4);
    if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
      refuse(name_, "a size that no table has");
    if (code >= kCompressions.size())
      refuse(name_, fmt::format("compression {}: lossy, which a table must not be, or unknown", code));
    const Compression& c = kCompressions[code];
    // a block is allocated whole, be the image lower or not; and the table of blocks has 8 bytes for each
    const auto length = static_cast<std::int64_t>(bytes_.size());
    if (width * pixel * std::max(height, c.lines) > length * c.ratio ||
        (height + c.lines - 1) / c.lines * 8 > length)
      refuse(name_, "more pixels than its length can hold");
  }

  std::string_view bytes_;
  std::string name_;
  std::size_t at_ = 0;
};

}  // namespace

std::string channelsToExr(const ExrFile& file) {
  namespace imf = OPENEXR_IMF_NAMESPACE;
  const std::size_t count = file.width * file.height;
  if (file.width == 0 || file.height == 0 || file.width > kMaxSide || file.height > kMaxSide ||
      file.names.size() != file.channels.size() ||
      std::any_of(file.channels.begin(), file.channels.end(),
                  [&](const auto& c) { return c.size() != count; })) {
    throw std::invalid_argument("EXR: channels and sizes do not fit");
  }
  imf::Header header(static_cast<int>(file.width), static_cast<int>(file.height));
  header.compression() = imf::ZIP_COMPRESSION;
  for (const auto& [key, value] : file.attributes) header.insert(key, imf::StringAttribute(value));
  const bool half = file.precision == Precision::kHalf;
  const imf::PixelType type = half ? imf::HALF : imf::FLOAT;
  imf::FrameBuffer frame;
  std::vector<std::string> storage(file.channels.size());
  const std::size_t size = half ? 2 : 4;
  for (std::size_t c = 0; c < file.channels.size(); ++c) {
    appendValues(storage[c], file.channels[c], file.precision);
    header.channels().insert(file.names[c], imf::Channel(type));
    frame.insert(file.names[c], imf::Slice(type, storage[c].data(), size, size * file.width));
  }
  StringOutput stream;
  {
    imf::OutputFile output(stream, header);
    output.setFrameBuffer(frame);
    output.writePixels(static_cast<int>(file.height));
  }
  return std::move(stream.bytes());
}

bool isExr(std::string_view bytes) {
  return bytes.starts_with(kMagic);
}

ExrFile parseExr(std::string_view bytes, const std::string& name) {
  namespace imf = OPENEXR_IMF_NAMESPACE;
  HeaderCheck(bytes, name).run();
  ExrFile file;
  try {
    StringInput stream(bytes);
    imf::InputFile input(stream, 1);
    const imf::Header& header = input.header();
    const auto& window = header.dataWindow();
    file.width = static_cast<std::size_t>(std::int64_t{window.max.x} - window.min.x + 1);
    file.height = static_cast<std::size_t>(std::int64_t{window.max.y} - window.min.y + 1);
    bool half = true;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      half = half && c.channel().type == imf::HALF;
      file.names.emplace_back(c.name());
    }
    file.precision = half ? Precision::kHalf : Precision::kFloat;
    file.channels.assign(file.names.size(), std::vector<float>(file.width * file.height));
    imf::FrameBuffer frame;
    for (std::size_t c = 0; c < file.names.size(); ++c) {
      // slices are addressed from the origin, which the data window need not hold: an address, not a pointer
      const auto first = reinterpret_cast<std::uintptr_t>(file.channels[c].data());
      const auto offset =
          (std::int64_t{window.min.y} * static_cast<std::int64_t>(file.width) + window.min.x) *
          static_cast<std::int64_t>(sizeof(float));
      auto* const origin = reinterpret_cast<char*>(first - static_cast<std::uintptr_t>(offset));
      frame.insert(file.names[c], imf::Slice(imf::FLOAT, origin, sizeof(float), sizeof(float) * file.width));
    }
    input.setFrameBuffer(frame);
    input.readPixels(window.min.y, window.max.y);
    for (auto a = header.begin(); a != header.end(); ++a) {
      if (const auto* text = dynamic_cast<const imf::StringAttribute*>(&a.attribute()))
        file.attributes.emplace_back(a.name(), text->value());
    }
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse(name, fmt::format("damaged ({})", error.what()));
  }
  return file;
}

}  // namespace ltcfit
