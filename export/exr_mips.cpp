#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfStringAttribute.h>
#include <ImfTiledInputFile.h>
#include <ImfTiledOutputFile.h>
#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "export/exr.h"
#include "export/exr_header.h"
#include "export/little_endian.h"
#include "export/mip_chain.h"

namespace ltcfit {
namespace {

namespace imf = OPENEXR_IMF_NAMESPACE;

constexpr std::array<const char*, 4> kExrChannels{"R", "G", "B", "A"};
constexpr unsigned kTileSide = 64;

// Of the four channels, one after the other in each texel.
imf::FrameBuffer frameOf(char* texels, imf::PixelType type, std::size_t width) {
  const std::size_t size = type == imf::HALF ? 2 : 4;
  imf::FrameBuffer frame;
  for (std::size_t c = 0; c < kExrChannels.size(); ++c)
    frame.insert(kExrChannels[c], imf::Slice(type, texels + c * size, 4 * size, 4 * size * width));
  return frame;
}

}  // namespace

std::string mipsToExr(const ExrMips& file) {
  if (!isMipChain(file.levels) || file.levels.back().texels() != 1 || file.levels.size() > kMaxLevels)
    throw std::invalid_argument("EXR: the levels are no chain of mip maps down to one texel");
  const Image& finest = file.levels[0];
  const imf::PixelType type = finest.precision == Precision::kHalf ? imf::HALF : imf::FLOAT;
  imf::Header header(static_cast<int>(finest.width), static_cast<int>(finest.height));
  header.compression() = imf::ZIP_COMPRESSION;
  header.setTileDescription(imf::TileDescription(kTileSide, kTileSide, imf::MIPMAP_LEVELS, imf::ROUND_DOWN));
  for (const auto& [key, value] : file.attributes) header.insert(key, imf::StringAttribute(value));
  for (const char* channel : kExrChannels) header.channels().insert(channel, imf::Channel(type));
  ExrOutput stream;
  {
    imf::TiledOutputFile output(stream, header);
    for (int l = 0; l < output.numLevels(); ++l) {
      const Image& level = file.levels[static_cast<std::size_t>(l)];
      std::string texels;
      appendValues(texels, level.values, level.precision);
      output.setFrameBuffer(frameOf(texels.data(), type, level.width));
      output.writeTiles(0, output.numXTiles(l) - 1, 0, output.numYTiles(l) - 1, l);
    }
  }
  return std::move(stream.bytes());
}

ExrMips parseExrMips(std::string_view bytes, const std::string& name) {
  checkExrHeader(bytes, name, ExrKind::kMips);
  ExrMips file;
  try {
    ExrInput stream(bytes);
    imf::TiledInputFile input(stream, 1);
    const imf::Header& header = input.header();
    const auto& window = header.dataWindow();
    if (window.min.x != 0 || window.min.y != 0) throw std::runtime_error("data window not from the origin");
    Image finest;
    finest.width = static_cast<std::size_t>(window.max.x) + 1;
    finest.height = static_cast<std::size_t>(window.max.y) + 1;
    bool half = true;
    for (const char* channel : kExrChannels) {
      const imf::Channel* const found = header.channels().findChannel(channel);
      if (found == nullptr) throw std::runtime_error(fmt::format("no channel {}", channel));
      half = half && found->type == imf::HALF;
    }
    finest.precision = half ? Precision::kHalf : Precision::kFloat;
    file.levels = mipLevels(finest, static_cast<std::size_t>(input.numLevels()));
    for (int l = 0; l < input.numLevels(); ++l) {
      Image& level = file.levels[static_cast<std::size_t>(l)];
      level.values.resize(level.texels() * 4);
      input.setFrameBuffer(frameOf(reinterpret_cast<char*>(level.values.data()), imf::FLOAT, level.width));
      input.readTiles(0, input.numXTiles(l) - 1, 0, input.numYTiles(l) - 1, l);
    }
    file.attributes = exrTexts(header);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuseExr(name, fmt::format("damaged, or of another layout ({})", error.what()));
  }
  return file;
}

}  // namespace ltcfit
