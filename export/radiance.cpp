#include "export/radiance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <system_error>
#include <vector>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

// Headers are a few lines; some tools add all commands that made the picture.
constexpr std::size_t kMaxHeader = std::size_t{1} << 16;
// Widths that the newer encoding has a place for.
constexpr std::size_t kLeastRle = 8;
constexpr std::size_t kMostRle = 32767;
constexpr std::size_t kRadianceChannels = 4;

using Pixel = std::array<std::uint8_t, kRadianceChannels>;

struct Header {
  double exposure = 1.0;
  std::size_t slow = 0;  // scanlines
  std::size_t fast = 0;  // pixels of one
  bool slowIsY = true;
  bool slowIsReversed = false;  // from the bottom, or from the right
  bool fastIsReversed = false;
};

// Takes bytes from the front of a file.
class Reader {
 public:
  Reader(std::string_view rest, const std::string& name) : rest_(rest), name_(name) {}

  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": HDR: " + what); }
  std::uint8_t byte() {
    if (rest_.empty()) fail(place_ + "cut off");
    const auto value = static_cast<std::uint8_t>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }
  std::string_view line() {
    const std::size_t end = rest_.substr(0, kMaxHeader).find('\n');
    if (end == std::string_view::npos) fail("cut off in its header");
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
  std::string_view rest() const { return rest_; }
  /// In front of what messages say.
  void enter(std::size_t scanline) { place_ = fmt::format("scanline {}: ", scanline); }
  const std::string& place() const { return place_; }

 private:
  std::string_view rest_;
  const std::string& name_;
  std::string place_;
};

template <typename T>
std::optional<T> numberOf(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  T value{};
  const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view behind(last, static_cast<std::size_t>(text.data() + text.size() - last));
  if (error != std::errc() || behind.find_first_not_of(' ') != std::string_view::npos) return std::nullopt;
  return value;
}

// "-Y 480 +X 640": the axis of the scanlines, then that of the pixels in one. Y grows upwards: -Y is from the
// top.
void readResolution(std::string_view line, Header& header, const Reader& reader) {
  const auto refuse = [&] {
    reader.fail(fmt::format("no size and orientation in '{}'", line.substr(0, 40)));
  };
  const std::size_t middle = line.find_first_of("+-", 1);
  if (middle == std::string_view::npos || middle < 4 || line.size() < middle + 4) refuse();
  const auto isAxis = [](std::string_view part, char axis) {
    return (part[0] == '+' || part[0] == '-') && part[1] == axis && part[2] == ' ';
  };
  const std::string_view slow = line.substr(0, middle);
  const std::string_view fast = line.substr(middle);
  header.slowIsY = isAxis(slow, 'Y');
  if (!isAxis(slow, header.slowIsY ? 'Y' : 'X') || !isAxis(fast, header.slowIsY ? 'X' : 'Y')) refuse();
  const auto isReversed = [](std::string_view part) { return (part[0] == '+') == (part[1] == 'Y'); };
  header.slowIsReversed = isReversed(slow);
  header.fastIsReversed = isReversed(fast);
  const std::optional<std::size_t> slowSize = numberOf<std::size_t>(slow.substr(3));
  const std::optional<std::size_t> fastSize = numberOf<std::size_t>(fast.substr(3));
  if (!slowSize || !fastSize) refuse();
  header.slow = *slowSize;
  header.fast = *fastSize;
}

Header readHeader(Reader& reader) {
  constexpr std::string_view kExposure = "EXPOSURE=";
  constexpr std::string_view kFormat = "FORMAT=";
  Header header;
  const std::size_t start = reader.rest().size();
  bool hasFormat = false;
  reader.line();  // the magic
  for (std::string_view line = reader.line(); !line.empty(); line = reader.line()) {
    if (start - reader.rest().size() > kMaxHeader) reader.fail("a header of more than 64 KiB");
    if (line.starts_with(kFormat)) {
      hasFormat = true;
      if (line.substr(kFormat.size()) != "32-bit_rle_rgbe")
        reader.fail(fmt::format("'{}' is not read; need FORMAT=32-bit_rle_rgbe", line.substr(0, 40)));
    } else if (line.starts_with(kExposure)) {
      const std::optional<double> factor = numberOf<double>(line.substr(kExposure.size()));
      if (!factor || !std::isfinite(*factor) || !(*factor > 0.0))
        reader.fail(fmt::format("'{}' is no number above 0", line.substr(0, 40)));
      header.exposure *= *factor;
    }
  }
  if (!hasFormat) reader.fail("no FORMAT in its header");
  if (!std::isnormal(header.exposure)) reader.fail("its EXPOSURE values have no product");
  readResolution(reader.line(), header, reader);
  return header;
}

// Each channel for itself: a count above 128 is a run of count - 128 equal bytes, else so many bytes follow.
void readRle(Reader& reader, std::vector<Pixel>& scanline) {
  for (std::size_t c = 0; c < kRadianceChannels; ++c) {
    for (std::size_t i = 0; i < scanline.size();) {
      const std::size_t count = reader.byte();
      const bool isRun = count > 128;
      const std::size_t length = isRun ? count - 128 : count;
      if (length == 0 || length > scanline.size() - i)
        reader.fail(reader.place() + "a run of a wrong length");
      std::uint8_t value = isRun ? reader.byte() : std::uint8_t{0};
      for (const std::size_t end = i + length; i < end; ++i) {
        if (!isRun) value = reader.byte();
        scanline[i][c] = value;
      }
    }
  }
}

// Pixel after pixel. (1, 1, 1, n) is n times the last one; of several in a row each has 8 bits more of the
// number. `first` was read already.
void readFlat(Reader& reader, const Pixel& first, std::vector<Pixel>& scanline) {
  std::size_t repeats = 0;  // in a row
  Pixel pixel = first;
  for (std::size_t i = 0; i < scanline.size();) {
    if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
      const std::size_t length = repeats < 3 ? std::size_t{pixel[3]} << (8 * repeats) : SIZE_MAX;
      if (i == 0 || length > scanline.size() - i) reader.fail(reader.place() + "a run of a wrong length");
      std::fill_n(scanline.begin() + static_cast<std::ptrdiff_t>(i), length, scanline[i - 1]);
      i += length;
      ++repeats;
    } else {
      scanline[i++] = pixel;
      repeats = 0;
    }
    if (i < scanline.size())
      for (std::uint8_t& v : pixel) v = reader.byte();
  }
}

void readScanline(Reader& reader, std::vector<Pixel>& scanline) {
  const std::size_t n = scanline.size();
  Pixel first;
  for (std::uint8_t& v : first) v = reader.byte();
  const bool isRle = n >= kLeastRle && n <= kMostRle && first[0] == 2 && first[1] == 2 && first[2] < 128;
  if (!isRle) return readFlat(reader, first, scanline);
  if ((std::size_t{first[2]} << 8 | first[3]) != n) reader.fail(reader.place() + "is of another length");
  readRle(reader, scanline);
}

}  // namespace

bool isRadiance(std::string_view bytes) {
  return bytes.starts_with("#?RADIANCE") || bytes.starts_with("#?RGBE");
}

LinearPicture parseRadiance(std::string_view bytes, const std::string& name) {
  Reader reader(bytes, name);
  if (!isRadiance(bytes)) reader.fail("not a picture of Radiance");
  const Header header = readHeader(reader);
  const std::size_t width = header.slowIsY ? header.fast : header.slow;
  const std::size_t height = header.slowIsY ? header.slow : header.fast;
  checkPictureSize(width, height, name);
  // a scanline takes a pixel and, where it has more than one, a run or a pixel more
  if (header.slow * (header.fast > 1 ? 8 : 4) > reader.rest().size())
    reader.fail("more pixels than its length can hold");
  LinearPicture picture{width, height, {}};
  picture.texels.assign(width * height, Eigen::Vector3d::Zero());
  std::vector<Pixel> scanline(header.fast);
  for (std::size_t s = 0; s < header.slow; ++s) {
    reader.enter(s);
    readScanline(reader, scanline);
    const std::size_t row = header.slowIsReversed ? header.slow - 1 - s : s;
    for (std::size_t f = 0; f < header.fast; ++f) {
      const std::size_t column = header.fastIsReversed ? header.fast - 1 - f : f;
      const auto [r, g, b, e] = scanline[f];
      if (e == 0) continue;
      const double scale = std::ldexp(1.0, static_cast<int>(e) - 136) / header.exposure;
      picture.texels[header.slowIsY ? row * width + column : column * width + row] =
          scale * Eigen::Vector3d(r, g, b);
    }
  }
  return picture;
}

}  // namespace ltcfit
