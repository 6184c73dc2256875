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
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "export/atomic_file.h"
#include "export/little_endian.h"

namespace ltcfit {
namespace {

constexpr std::string_view kMagic("\x76\x2F\x31\x01", 4);
constexpr int kMaxSide = 16384;
// No compression of OpenEXR makes less than a thousandth of its data (deflate's limit is 1032).
constexpr std::size_t kMaxRatio = 1032;

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
  const auto refuse = [&](const std::string& what) { throw InputError(name + ": EXR: " + what); };
  ExrFile file;
  try {
    imf::Header::setMaxImageSize(kMaxSide, kMaxSide);
    StringInput stream(bytes);
    imf::InputFile input(stream, 1);
    const imf::Header& header = input.header();
    const auto& window = header.dataWindow();
    const auto width = std::int64_t{window.max.x} - window.min.x + 1;
    const auto height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) refuse("a size that no table has");
    file.width = static_cast<std::size_t>(width);
    file.height = static_cast<std::size_t>(height);
    bool half = true;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      if (c.channel().type == imf::UINT || c.channel().xSampling != 1 || c.channel().ySampling != 1)
        refuse(fmt::format("channel '{}' is not one of numbers at every pixel", c.name()));
      half = half && c.channel().type == imf::HALF;
      file.names.emplace_back(c.name());
    }
    if (file.names.empty()) refuse("no channels");
    file.precision = half ? Precision::kHalf : Precision::kFloat;
    const std::size_t count = file.width * file.height;
    if (count * file.names.size() * 2 / kMaxRatio > bytes.size())
      refuse("more pixels than its length can hold");
    file.channels.assign(file.names.size(), std::vector<float>(count));
    imf::FrameBuffer frame;
    for (std::size_t c = 0; c < file.names.size(); ++c) {
      // slices are addressed from the origin, which the data window need not hold
      auto* const first = reinterpret_cast<char*>(file.channels[c].data());
      const std::ptrdiff_t offset =
          (std::ptrdiff_t{window.min.y} * width + window.min.x) * static_cast<std::ptrdiff_t>(sizeof(float));
      frame.insert(file.names[c], imf::Slice(imf::FLOAT, first - offset, sizeof(float),
                                             sizeof(float) * static_cast<std::size_t>(width)));
    }
    input.setFrameBuffer(frame);
    input.readPixels(window.min.y, window.max.y);
    for (auto a = header.begin(); a != header.end(); ++a) {
      if (const auto* text = dynamic_cast<const imf::StringAttribute*>(&a.attribute()))
        file.attributes.emplace_back(a.name(), text->value());
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse(fmt::format("damaged ({})", error.what()));
  }
  return file;
}

}  // namespace ltcfit
