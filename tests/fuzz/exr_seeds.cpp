// Writes small EXR files of every lossless compression into a folder: a fuzzer does not find PIZ' codes
// alone.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include <string>
#include <vector>

int main(int argc, char** argv) {
  namespace imf = OPENEXR_IMF_NAMESPACE;
  if (argc != 2) return 2;
  constexpr int kWidth = 5;
  constexpr int kHeight = 40;  // more than a block of any compression has lines
  std::vector<float> pixels(kWidth * kHeight);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = i % 3 == 0 ? 0.0f : 0.25f * static_cast<float>(i);
  std::vector<std::uint16_t> halves(pixels.size());
  for (std::size_t i = 0; i < halves.size(); ++i) halves[i] = static_cast<std::uint16_t>(0x3800 + 7 * i);
  for (const auto compression : {imf::NO_COMPRESSION, imf::RLE_COMPRESSION, imf::ZIPS_COMPRESSION,
                                 imf::ZIP_COMPRESSION, imf::PIZ_COMPRESSION}) {
    // the data window lies away from the origin
    const IMATH_NAMESPACE::Box2i window({-2, 3}, {-2 + kWidth - 1, 3 + kHeight - 1});
    imf::Header header(window, window);
    header.compression() = compression;
    header.channels().insert("m00", imf::Channel(imf::FLOAT));
    header.channels().insert("norm", imf::Channel(imf::HALF));
    imf::FrameBuffer frame;
    frame.insert("m00", imf::Slice::Make(imf::FLOAT, pixels.data(), window));
    frame.insert("norm", imf::Slice::Make(imf::HALF, halves.data(), window));
    imf::OutputFile file((std::string(argv[1]) + "/seed" + std::to_string(compression) + ".exr").c_str(),
                         header);
    file.setFrameBuffer(frame);
    file.writePixels(kHeight);
  }
  return 0;
}
