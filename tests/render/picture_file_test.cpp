// Pictures for lights, through files of each kind.
#include "render/picture_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <limits>

#include "export/atomic_file.h"
#include "export/exr.h"

namespace ltcfit {
namespace {

using Eigen::Vector3d;

void expectNear(const Vector3d& found, const Vector3d& expected, double tolerance) {
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance)
      << found.transpose() << ", not " << expected.transpose();
}

TEST(PictureFile, ExrIsLinear) {
  const std::string path = fmt::format("{}ltcfit-picture-{}.exr", testing::TempDir(), ::getpid());
  ExrFile file{2, 1, Precision::kFloat, {"B", "G", "R", "A"}, {{3, 6}, {2, 5}, {1, -4}, {0.5f, 0}}, {}};
  writeFileAtomically(path, channelsToExr(file));
  const LinearPicture picture = readPicture(path);
  expectNear(picture.texels[0], {1, 2, 3}, 0.0);
  expectNear(picture.texels[1], {0, 5, 6}, 0.0);  // no light has -4
  file = {2, 1, Precision::kHalf, {"Y"}, {{0.25f, 7}}, {}};
  writeFileAtomically(path, channelsToExr(file));
  expectNear(readPicture(path).texels[1], Vector3d::Constant(7), 0.0);
  file.channels[0][1] = std::numeric_limits<float>::infinity();
  writeFileAtomically(path, channelsToExr(file));
  EXPECT_THROW(readPicture(path), InputError);
  file = {1, 1, Precision::kHalf, {"R", "G"}, {{1}, {1}}, {}};
  writeFileAtomically(path, channelsToExr(file));
  EXPECT_THROW(readPicture(path), InputError);
  writeFileAtomically(path, "hello");
  EXPECT_THROW(readPicture(path), InputError);
}

// Flat blocks of 8 x 8: grey 160 and 200, which a JPEG keeps.
TEST(PictureFile, JpegIsSrgb) {
  const std::string path = std::string(LTCFIT_DATA_DIR) + "/scenes/metal_rough.jpg";
  const LinearPicture picture = readPicture(path);
  ASSERT_EQ(picture.width, 16u);
  ASSERT_EQ(picture.height, 16u);
  // by IEC 61966-2-1: ((160 / 255 + 0.055) / 1.055)^2.4 and so on
  expectNear(picture.texels[0], Vector3d::Constant(0.3515326), 1e-7);
  expectNear(picture.texels[15 * 16], Vector3d::Constant(0.5775804), 1e-7);
  expectNear(picture.texels[15], Vector3d::Zero(), 0.0);
  const std::string bytes = readFile(path);
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_THROW(parseJpeg(std::string_view(bytes).substr(0, n), "P"), InputError) << n;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    try {
      parseJpeg(flipped, "P");
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("P: ", 0), 0u) << error.what();
    }
  }
  std::string huge = bytes;
  const std::size_t frame = huge.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  for (std::size_t i = 5; i < 9; ++i) huge[frame + i] = '\x30';
  EXPECT_THROW(parseJpeg(huge, "P"), InputError);
  for (std::size_t i = 5; i < 9; ++i) huge[frame + i] = '\x1f';
  EXPECT_THROW(parseJpeg(huge, "P"), InputError);
}

TEST(PictureFile, RadianceIsLinear) {
  const std::string path = fmt::format("{}ltcfit-picture-{}.hdr", testing::TempDir(), ::getpid());
  using namespace std::string_literals;
  writeFileAtomically(path, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x40\x20\x82"s);
  expectNear(readPicture(path).texels.at(0), {2.0, 1.0, 0.5}, 0.0);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace ltcfit
