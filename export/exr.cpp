#include "export/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "export/exr_header.h"
#include "export/little_endian.h"

namespace ltcfit {

std::string channelsToExr(const ExrFile& file) {
  namespace imf = OPENEXR_IMF_NAMESPACE;
  const std::size_t count = file.width * file.height;
  if (file.width == 0 || file.height == 0 || file.width > kMaxExrSide || file.height > kMaxExrSide ||
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
  ExrOutput stream;
  {
    imf::OutputFile output(stream, header);
    output.setFrameBuffer(frame);
    output.writePixels(static_cast<int>(file.height));
  }
  return std::move(stream.bytes());
}

bool isExr(std::string_view bytes) {
  return bytes.starts_with(kExrMagic);
}

namespace {

bool isShown(const OPENEXR_IMF_NAMESPACE::ChannelList& all, std::string_view channel) {
  const bool colour = all.findChannel("R") != nullptr;
  return colour ? channel == "R" || channel == "G" || channel == "B" : channel == "Y";
}

ExrFile parse(std::string_view bytes, const std::string& name, ExrKind kind) {
  namespace imf = OPENEXR_IMF_NAMESPACE;
  checkExrHeader(bytes, name, kind);
  ExrFile file;
  try {
    ExrInput stream(bytes);
    imf::InputFile input(stream, 1);
    const imf::Header& header = input.header();
    const auto& window = header.dataWindow();
    file.width = static_cast<std::size_t>(std::int64_t{window.max.x} - window.min.x + 1);
    file.height = static_cast<std::size_t>(std::int64_t{window.max.y} - window.min.y + 1);
    bool half = true;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      if (kind == ExrKind::kPicture && !isShown(header.channels(), c.name())) continue;
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
    file.attributes = exrTexts(header);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuseExr(name, fmt::format("damaged ({})", error.what()));
  }
  return file;
}

}  // namespace

ExrFile parseExr(std::string_view bytes, const std::string& name) {
  return parse(bytes, name, ExrKind::kTable);
}

ExrFile parseExrPicture(std::string_view bytes, const std::string& name) {
  return parse(bytes, name, ExrKind::kPicture);
}

}  // namespace ltcfit
