// EXR pictures as renderers and image tools write them, by OpenEXR itself: compressions, channels, windows;
// what is refused says how to convert it.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "export/atomic_file.h"
#include "export/exr.h"
#include "export/picture.h"

namespace ltcfit {
namespace {

namespace imf = OPENEXR_IMF_NAMESPACE;
using Window = IMATH_NAMESPACE::Box2i;

constexpr int kWidth = 40;
constexpr int kHeight = 300;  // more than a block of any compression, and no multiple of one
const Window kWindow({0, 0}, {kWidth - 1, kHeight - 1});

struct Channel {
  const char* name;
  imf::PixelType type = imf::FLOAT;
  int sampling = 1;
};

struct File {
  std::vector<Channel> channels;
  imf::Compression compression = imf::ZIP_COMPRESSION;
  Window data = kWindow;
  Window display = kWindow;
  bool tiled = false;
};

// Smooth, from 0.5 up, another one for each channel.
double valueAt(std::size_t channel, std::size_t pixel) {
  const double x = static_cast<double>(pixel % kWidth) / kWidth;
  const double y = static_cast<double>(pixel / kWidth) / kHeight;
  return 0.5 + static_cast<double>(channel) + std::sin(3.0 * x) * y;
}

std::string bytesOf(const File& file) {
  const std::string path = fmt::format("{}ltcfit-exr-picture-{}.exr", testing::TempDir(), ::getpid());
  imf::Header header(file.display, file.data);
  header.compression() = file.compression;
  if (file.tiled) header.setTileDescription(imf::TileDescription(16, 16, imf::ONE_LEVEL));
  std::vector<std::string> storage(file.channels.size());
  imf::FrameBuffer frame;
  for (std::size_t c = 0; c < file.channels.size(); ++c) {
    const auto& [name, type, sampling] = file.channels[c];
    const std::size_t size = type == imf::HALF ? 2 : 4;
    storage[c].resize(kWidth * kHeight * size);
    for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
      const auto value = static_cast<float>(valueAt(c, i));
      char* const at = storage[c].data() + i * size;
      if (type == imf::HALF) *reinterpret_cast<half*>(at) = half(value);
      if (type == imf::FLOAT) *reinterpret_cast<float*>(at) = value;
      if (type == imf::UINT) *reinterpret_cast<unsigned*>(at) = static_cast<unsigned>(i);
    }
    header.channels().insert(name, imf::Channel(type, sampling, sampling));
    frame.insert(
        name, imf::Slice::Make(type, storage[c].data(), file.data, size, size * kWidth, sampling, sampling));
  }
  if (file.tiled) {
    imf::TiledOutputFile output(path.c_str(), header);
    output.setFrameBuffer(frame);
    output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
  } else {
    imf::OutputFile output(path.c_str(), header);
    output.setFrameBuffer(frame);
    output.writePixels(kHeight);
  }
  std::string bytes = readFile(path, 1 << 26);
  std::filesystem::remove(path);
  return bytes;
}

std::string refusal(const std::string& bytes) {
  try {
    parseExrPicture(bytes, "P");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

void expectRefused(const std::string& bytes, const std::string& why) {
  const std::string message = refusal(bytes);
  EXPECT_EQ(message.rfind("P: EXR: ", 0), 0u) << message;
  EXPECT_NE(message.find(why), std::string::npos) << message << "\nhas no " << why;
  EXPECT_EQ(message.find("table"), std::string::npos) << message;
}

TEST(ExrPicture, OfAnyCompression) {
  struct Case {
    imf::Compression compression;
    double error;  // relative
  };
  // of halves 2^-11; B44 is off by 0.004 here (floats it keeps), DWA at its default level by 0.008
  for (const auto& [compression, error] :
       {Case{imf::NO_COMPRESSION, 5e-4}, Case{imf::RLE_COMPRESSION, 5e-4}, Case{imf::ZIPS_COMPRESSION, 5e-4},
        Case{imf::ZIP_COMPRESSION, 5e-4}, Case{imf::PIZ_COMPRESSION, 5e-4},
        Case{imf::PXR24_COMPRESSION, 5e-4}, Case{imf::B44_COMPRESSION, 0.01},
        Case{imf::B44A_COMPRESSION, 0.01}, Case{imf::DWAA_COMPRESSION, 0.01},
        Case{imf::DWAB_COMPRESSION, 0.01}}) {
    for (const imf::PixelType type : {imf::HALF, imf::FLOAT}) {
      const std::string bytes = bytesOf({{{"R", type}, {"G", type}, {"B", type}}, compression});
      const ExrFile file = parseExrPicture(bytes, "P");
      ASSERT_EQ(file.names, (std::vector<std::string>{"B", "G", "R"}));
      double worst = 0.0;
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_EQ(file.channels[2 - c].size(), std::size_t{kWidth * kHeight});
        for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
          const double found = static_cast<double>(file.channels[2 - c][i]);
          worst = std::max(worst, std::abs(found - valueAt(c, i)) / valueAt(c, i));
        }
      }
      EXPECT_LT(worst, error) << "compression " << compression;
      if (compression < imf::PXR24_COMPRESSION) {
        EXPECT_NO_THROW(parseExr(bytes, "T"));
      } else {
        EXPECT_THROW(parseExr(bytes, "T"), InputError) << compression;
      }
    }
  }
}

TEST(ExrPicture, OtherChannelsArePassedOver) {
  const ExrFile colour = parseExrPicture(
      bytesOf({{{"R"}, {"G"}, {"B"}, {"A"}, {"Y"}, {"Z"}, {"id", imf::UINT}, {"depth.V", imf::HALF}}}), "P");
  ASSERT_EQ(colour.names, (std::vector<std::string>{"B", "G", "R"}));
  EXPECT_FLOAT_EQ(colour.channels[0][7], static_cast<float>(valueAt(2, 7)));
  const ExrFile grey = parseExrPicture(bytesOf({{{"Y"}, {"Z"}, {"A"}}}), "P");
  ASSERT_EQ(grey.names, (std::vector<std::string>{"Y"}));
  EXPECT_FLOAT_EQ(grey.channels[0][7], static_cast<float>(valueAt(0, 7)));
}

TEST(ExrPicture, ChannelsThatAreNoPicture) {
  expectRefused(bytesOf({{{"X"}, {"Y"}, {"Z"}}}), "it has X, Y, Z. CIE X, Y and Z");
  expectRefused(bytesOf({{{"Y"}, {"RY", imf::HALF, 2}, {"BY", imf::HALF, 2}}}),
                "it has BY, RY, Y. Luminance and chroma");
  expectRefused(bytesOf({{{"a.R"}, {"a.G"}, {"a.B"}}}),
                "it has a.B, a.G, a.R. Convert it, e.g. by `oiiotool in.exr --ch R,G,B -o out.exr`");
  expectRefused(bytesOf({{{"R"}, {"G"}}}), "it has G, R.");
  expectRefused(bytesOf({{{"R"}, {"Y"}}}), "it has R, Y.");
  expectRefused(bytesOf({{{"R"}, {"G"}, {"B", imf::UINT}}}), "channel 'B'");
  expectRefused(bytesOf({{{"R"}, {"G"}, {"B"}, {"u", imf::FLOAT, 2}}}),
                "channel 'u' is not one of numbers at every pixel; leave it out, e.g. by `oiiotool");
  std::vector<std::string> names;
  std::vector<Channel> many;
  for (int i = 0; i < 30; ++i) names.push_back(fmt::format("c{}", 100 + i));
  for (const std::string& name : names) many.push_back({name.c_str(), imf::HALF});
  expectRefused(bytesOf({many}), "c115, ....");
}

TEST(ExrPicture, WindowsAndParts) {
  const std::vector<Channel> rgb{{"R"}, {"G"}, {"B"}};
  const Window moved({-5, 7}, {-5 + kWidth - 1, 7 + kHeight - 1});
  EXPECT_EQ(refusal(bytesOf({rgb, imf::ZIP_COMPRESSION, moved, moved})), "accepted");
  expectRefused(bytesOf({rgb, imf::ZIP_COMPRESSION, kWindow, moved}), "oiiotool in.exr --croptofull");
  const Window larger({0, 0}, {kWidth, kHeight - 1});
  expectRefused(bytesOf({rgb, imf::ZIP_COMPRESSION, kWindow, larger}), "not the display window");
  expectRefused(
      bytesOf({rgb, imf::ZIP_COMPRESSION, kWindow, kWindow, true}),
      "a tiled picture; need scan lines: convert it, e.g. by `oiiotool in.exr --scanline -o out.exr`");
  std::string parts = bytesOf({rgb});
  parts[5] = 16;
  expectRefused(parts, "several parts; need one of scan lines");
  parts[5] = 8;
  expectRefused(parts, "deep");
}

TEST(ExrPicture, ClaimsOfSizeAreChecked) {
  const std::string key("Window\0box2i\0", 13);
  for (const imf::Compression compression :
       {imf::PXR24_COMPRESSION, imf::B44A_COMPRESSION, imf::DWAB_COMPRESSION}) {
    std::string bytes = bytesOf({{{"R"}, {"G"}, {"B"}}, compression});
    const auto claim = [&](int width, int height) {
      for (std::size_t at = bytes.find(key); at != std::string::npos; at = bytes.find(key, at + 1)) {
        for (std::size_t k = 0; k < 4; ++k) {
          bytes[at + key.size() + 12 + k] = static_cast<char>((width - 1) >> (8 * k));
          bytes[at + key.size() + 16 + k] = static_cast<char>((height - 1) >> (8 * k));
        }
      }
    };
    claim(8193, 1);
    expectRefused(bytes, "8193 x 1 pixels; need 1 to 8192");
    bytes.resize(1000);
    claim(8192, 8192);
    expectRefused(bytes, "more pixels than its length can hold");
  }
}

// Of a length that bears them out by the ratio of the compression alone.
TEST(ExrPicture, ClaimsOfLongFilesAreBounded) {
  const std::string key("Window\0box2i\0", 13);
  std::string bytes = bytesOf({{{"R"}, {"G"}, {"B"}}, imf::ZIP_COMPRESSION});
  for (std::size_t at = bytes.find(key); at != std::string::npos; at = bytes.find(key, at + 1)) {
    bytes.replace(at + key.size() + 12, 8, std::string("\xFF\x3F\0\0\xFF\x3F\0\0", 8));  // 16384 a side
  }
  bytes.resize(std::size_t{4} << 20, '\0');
  try {
    parseExr(bytes, "E");
    ADD_FAILURE() << "read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("16384 x 16384 pixels of"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("more than the 1073741824 bytes"), std::string::npos)
        << error.what();
  }
}

TEST(ExrPicture, DamagedIsRefusedOrRead) {
  for (const imf::Compression compression :
       {imf::PXR24_COMPRESSION, imf::B44A_COMPRESSION, imf::DWAA_COMPRESSION, imf::DWAB_COMPRESSION}) {
    const std::string good = bytesOf({{{"R", imf::HALF}, {"G", imf::HALF}, {"B"}}, compression});
    for (std::size_t n = 0; n < good.size(); n += 97) expectRefused(good.substr(0, n), "");
    for (std::size_t at = 0; at < good.size(); at += at < 500 ? 1 : 31) {
      std::string bytes = good;
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << (at % 8)));
      const std::string message = refusal(bytes);
      if (message != "accepted") {
        EXPECT_EQ(message.rfind("P: EXR: ", 0), 0u) << message;
      }
    }
  }
}

}  // namespace
}  // namespace ltcfit
