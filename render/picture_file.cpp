#include "render/picture_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "export/atomic_file.h"
#include "export/exr.h"
#include "export/jpeg_reader.h"
#include "export/radiance.h"

namespace ltcfit {
namespace {

constexpr std::uint64_t kMaxPictureFile = std::uint64_t{1} << 30;

LinearPicture pictureOfExr(std::string_view bytes, const std::string& name) {
  const ExrFile file = parseExrPicture(bytes, name);
  // in the order of their names: B, G, R, or Y alone
  const std::size_t last = file.channels.size() - 1;
  LinearPicture picture{file.width, file.height, {}};
  picture.texels.resize(file.width * file.height);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t channel = last - std::min(c, last);
    const std::vector<float>& values = file.channels[channel];
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) {
        throw InputError(fmt::format("{}: EXR: channel {}, row {}, column {} is not finite", name,
                                     file.names[channel], i / file.width, i % file.width));
      }
      picture.texels[i][static_cast<Eigen::Index>(c)] = std::max(0.0, static_cast<double>(values[i]));
    }
  }
  return picture;
}

}  // namespace

bool isJpeg(std::string_view bytes) {
  return bytes.starts_with("\xff\xd8\xff");
}

LinearPicture parseJpeg(std::string_view bytes, const std::string& name) {
  JpegReader reader(bytes);
  const auto damaged = [&] { throw InputError(fmt::format("{}: JPEG: {}", name, reader.message())); };
  if (!reader.readHeader()) damaged();
  const std::size_t width = reader.width();
  const std::size_t height = reader.height();
  checkPictureSize(width, height, name);
  if (width * height / kJpegPixelsPerByte > bytes.size())
    throw InputError(name + ": JPEG: more pixels than its length can hold");
  std::vector<std::uint8_t> values(4 * width * height);
  if (!reader.readRows(values.data())) damaged();
  std::array<double, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = linearFromSrgb(static_cast<double>(i) / 255.0);
  LinearPicture picture{width, height, {}};
  picture.texels.reserve(width * height);
  for (std::size_t i = 0; i < values.size(); i += 4)
    picture.texels.emplace_back(linear[values[i]], linear[values[i + 1]], linear[values[i + 2]]);
  return picture;
}

LinearPicture readPicture(const std::string& path) {
  const std::string bytes = readFile(path, kMaxPictureFile);
  if (isPng(bytes)) return parsePng(bytes, path);
  if (isJpeg(bytes)) return parseJpeg(bytes, path);
  if (isRadiance(bytes)) return parseRadiance(bytes, path);
  if (isExr(bytes)) return pictureOfExr(bytes, path);
  throw InputError(path + ": neither a PNG, JPEG, Radiance (.hdr) nor EXR picture");
}

}  // namespace ltcfit
