#include "render/pictures.h"

#include <algorithm>
#include <cmath>

#include "base/diagnostics.h"
#include "render/letters.h"

namespace ltcfit {
namespace {

constexpr std::size_t kGap = 6;
constexpr std::size_t kLine = kLetterHeight + 6;  // of text with what is left around it
constexpr std::uint8_t kBackground = 24;
constexpr std::uint8_t kInk = 225;

std::uint8_t toSrgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

void put(Picture& sheet, std::size_t x, std::size_t y, const Picture& picture) {
  for (std::size_t row = 0; row < picture.height; ++row) {
    std::copy_n(picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * row * picture.width), 3 * picture.width,
                sheet.rgb.begin() + static_cast<std::ptrdiff_t>(3 * ((y + row) * sheet.width + x)));
  }
}

// What does not fit to the right is left out.
void write(Picture& sheet, std::size_t x, std::size_t y, const std::string& text) {
  for (const char c : text) {
    if (x + kLetterWidth > sheet.width) return;
    const auto rows = letterRows(c);
    for (std::size_t dy = 0; dy < kLetterHeight; ++dy)
      for (std::size_t dx = 0; dx < kLetterWidth; ++dx)
        if ((rows[dy] & 16u >> dx) != 0)
          std::fill_n(sheet.rgb.begin() + static_cast<std::ptrdiff_t>(3 * ((y + dy) * sheet.width + x + dx)),
                      3, kInk);
    x += kLetterWidth + 1;
  }
}

}  // namespace

Picture toPicture(const Film& film, std::size_t zoom) {
  Picture out;
  out.width = film.width * zoom;
  out.height = film.height * zoom;
  out.rgb.resize(3 * out.width * out.height);
  for (std::size_t y = 0; y < out.height; ++y) {
    for (std::size_t x = 0; x < out.width; ++x) {
      const Eigen::Vector3d& v = film.radiance[y / zoom * film.width + x / zoom];
      const Eigen::Vector3d shown = v.allFinite() ? v : Eigen::Vector3d(1, 0, 1);
      for (int c = 0; c < 3; ++c)
        out.rgb[3 * (y * out.width + x) + static_cast<std::size_t>(c)] = toSrgb(shown[c]);
    }
  }
  return out;
}

Film difference(const Film& a, const Film& b, double gain) {
  if (a.width != b.width || a.height != b.height)
    abortWith("difference: %zu x %zu and %zu x %zu", a.width, a.height, b.width, b.height);
  Film out(a.width, a.height);
  out.kinds = a.kinds;
  for (std::size_t i = 0; i < a.radiance.size(); ++i)
    if (a.kinds[i] == PixelKind::kSurface && b.kinds[i] == PixelKind::kSurface)
      out.radiance[i] = gain * (a.radiance[i] - b.radiance[i]).cwiseAbs();
  return out;
}

Picture contactSheet(const std::vector<std::string>& headings, const std::vector<SheetRow>& rows) {
  std::vector<std::size_t> widths;
  std::size_t height = kLine + kGap;
  for (const SheetRow& row : rows) {
    std::size_t tallest = 0;
    widths.resize(std::max(widths.size(), row.pictures.size()));
    for (std::size_t i = 0; i < row.pictures.size(); ++i) {
      widths[i] = std::max(widths[i], row.pictures[i].width);
      tallest = std::max(tallest, row.pictures[i].height);
    }
    height += kLine + tallest + kGap;
  }
  std::vector<std::size_t> left;
  std::size_t width = kGap;
  for (const std::size_t w : widths) {
    left.push_back(width);
    width += w + kGap;
  }
  Picture sheet;
  sheet.width = width;
  sheet.height = height;
  sheet.rgb.assign(3 * width * height, kBackground);
  std::size_t y = kGap;
  // cut where the column ends
  for (std::size_t i = 0; i < std::min(headings.size(), widths.size()); ++i)
    write(sheet, left[i], y, headings[i].substr(0, widths[i] / (kLetterWidth + 1)));
  y += kLine;
  for (const SheetRow& row : rows) {
    write(sheet, kGap, y, row.caption);
    y += kLine;
    std::size_t tallest = 0;
    for (std::size_t i = 0; i < row.pictures.size(); ++i) {
      put(sheet, left[i], y, row.pictures[i]);
      tallest = std::max(tallest, row.pictures[i].height);
    }
    y += tallest + kGap;
  }
  return sheet;
}

}  // namespace ltcfit
