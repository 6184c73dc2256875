// Writes small EXR files into a folder, tables of every lossless compression and pictures of every lossy one:
// a fuzzer does not find their codes alone.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include <string>
#include <vector>

int main(int argc, char** argv) {
  namespace imf = OPENEXR_IMF_NAMESPACE;
  if (argc != 2) return 2;
  const std::vector<const char*> kTable{"m00", "norm"};
  const std::vector<const char*> kPicture{"R", "G", "B"};
  constexpr int kWidth = 5;
  constexpr int kHeight = 40;        // more than a block of any lossless compression has lines
  constexpr int kPictureHeight = 8;  // the fuzzer reads short pictures only
  std::vector<float> pixels(kWidth * kHeight);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = i % 3 == 0 ? 0.0f : 0.25f * static_cast<float>(i);
  std::vector<std::uint16_t> halves(pixels.size());
  for (std::size_t i = 0; i < halves.size(); ++i) halves[i] = static_cast<std::uint16_t>(0x3800 + 7 * i);
  for (const auto compression :
       {imf::NO_COMPRESSION, imf::RLE_COMPRESSION, imf::ZIPS_COMPRESSION, imf::ZIP_COMPRESSION,
        imf::PIZ_COMPRESSION, imf::PXR24_COMPRESSION, imf::B44_COMPRESSION, imf::B44A_COMPRESSION,
        imf::DWAA_COMPRESSION, imf::DWAB_COMPRESSION}) {
    const bool picture = compression > imf::PIZ_COMPRESSION;
    const int height = picture ? kPictureHeight : kHeight;
    // the data window lies away from the origin
    const IMATH_NAMESPACE::Box2i window({-2, 3}, {-2 + kWidth - 1, 3 + height - 1});
    imf::Header header(window, window);
    header.compression() = compression;
    imf::FrameBuffer frame;
    for (const char* name : picture ? kPicture : kTable) {
      const bool half = name == kPicture[0] || name == kTable[1];
      header.channels().insert(name, imf::Channel(half ? imf::HALF : imf::FLOAT));
      frame.insert(name, half ? imf::Slice::Make(imf::HALF, halves.data(), window)
                              : imf::Slice::Make(imf::FLOAT, pixels.data(), window));
    }
    imf::OutputFile file((std::string(argv[1]) + "/seed" + std::to_string(compression) + ".exr").c_str(),
                         header);
    file.setFrameBuffer(frame);
    file.writePixels(height);
  }
  return 0;
}
