// Films as pictures for people, and the sentence about lost scenes.
#include "render/pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "render/letters.h"
#include "render/lost_scene.h"
#include "render/scenes.h"

namespace ltcfit {
namespace {

TEST(ToPicture, EncodesAsSrgbAndClips) {
  Film film(4, 1);
  film.radiance[0].setConstant(0.0);
  film.radiance[1].setConstant(0.5);
  film.radiance[2] = Eigen::Vector3d(1.0, 7.0, -1.0);
  film.radiance[3] = Eigen::Vector3d(std::nan(""), 0, 0);
  const Picture p = toPicture(film);
  const std::vector<std::uint8_t> expected{0, 0, 0, 188, 188, 188, 255, 255, 0, 255, 0, 255};
  EXPECT_EQ(p.rgb, expected);
}

TEST(ToPicture, ZoomRepeatsPixels) {
  Film film(2, 1);
  film.radiance[1].setConstant(1.0);
  const Picture p = toPicture(film, 3);
  ASSERT_EQ(p.width, 6u);
  ASSERT_EQ(p.height, 3u);
  for (std::size_t y = 0; y < 3; ++y)
    for (std::size_t x = 0; x < 6; ++x) EXPECT_EQ(p.rgb[3 * (y * 6 + x)], x < 3 ? 0 : 255);
}

TEST(Difference, IsAbsoluteAmplifiedAndOnSurfacesOnly) {
  Film a(2, 1);
  a.kinds.assign(2, PixelKind::kSurface);
  Film b = a;
  a.radiance[0] = Eigen::Vector3d(0.1, 0.3, 0.0);
  b.radiance[0] = Eigen::Vector3d(0.2, 0.1, 0.0);
  a.radiance[1].setConstant(9.0);
  b.kinds[1] = PixelKind::kLight;
  const Film d = difference(a, b, 5.0);
  EXPECT_LT((d.radiance[0] - Eigen::Vector3d(0.5, 1.0, 0.0)).norm(), 1e-12);
  EXPECT_EQ(d.radiance[1].norm(), 0.0);
}

TEST(Letters, AllThatCaptionsUseAreDrawnAndDiffer) {
  std::set<std::array<std::uint8_t, kLetterHeight>> seen;
  for (const char c : std::string("abcdefghijklmnopqrstuvwxyz0123456789.,:-_+%()/")) {
    const auto rows = letterRows(c);
    EXPECT_NE(rows, letterRows(' ')) << c;
    EXPECT_TRUE(seen.insert(rows).second) << c << " looks like another";
  }
  EXPECT_EQ(letterRows('a'), letterRows('A'));
  EXPECT_EQ(letterRows('L')[0], 16);
  EXPECT_EQ(letterRows('L')[6], 31);
}

TEST(ContactSheet, PutsPicturesUnderTheirHeadings) {
  Picture white{8, 3, std::vector<std::uint8_t>(72, 255)};
  Picture red{8, 3, {}};
  for (int i = 0; i < 24; ++i) red.rgb.insert(red.rgb.end(), {255, 0, 0});
  const Picture sheet = contactSheet({"l", "second"}, {{"x", {white, red}}, {"y", {white}}});
  ASSERT_EQ(sheet.rgb.size(), 3 * sheet.width * sheet.height);
  std::size_t reds = 0;
  std::size_t whites = 0;
  std::size_t leftmostRed = sheet.width;
  for (std::size_t i = 0; i < sheet.width * sheet.height; ++i) {
    const std::uint8_t* const p = &sheet.rgb[3 * i];
    if (p[0] == 255 && p[1] == 0) {
      ++reds;
      leftmostRed = std::min(leftmostRed, i % sheet.width);
    }
    if (p[0] == 255 && p[1] == 255) ++whites;
  }
  EXPECT_EQ(reds, 24u);
  EXPECT_EQ(whites, 48u);
  EXPECT_GT(leftmostRed, 6u + 6u);
  // the heading's L: its stem and foot
  const auto ink = [&](std::size_t x, std::size_t y) { return sheet.rgb[3 * (y * sheet.width + x)] > 200; };
  EXPECT_TRUE(ink(6, 6));
  EXPECT_TRUE(ink(6, 12));
  EXPECT_TRUE(ink(10, 12));
  EXPECT_FALSE(ink(10, 6));
}

// Films that are right but for what `change` does to the first one at some pixels.
template <class Change>
std::string explained(const Change& change) {
  const Scene scene = randomScene(1, 231, false, 24);
  Film reference(24, 24);
  for (std::size_t i = 0; i < 24 * 24; ++i) {
    const PixelView view = viewPixel(scene, i % 24, i / 24);
    reference.kinds[i] = view.kind;
    if (view.kind == PixelKind::kSurface) reference.radiance[i].setConstant(i % 2 == 0 ? 0.5 : 0.001);
  }
  Film ours = reference;
  Film theirs = reference;
  for (Eigen::Vector3d& v : theirs.radiance) v *= 1.0001;
  for (std::size_t i = 0; i < 24 * 24; ++i) {
    const PixelView view = viewPixel(scene, i % 24, i / 24);
    if (view.kind == PixelKind::kSurface) change(view.point.wo.z(), i % 2 == 1, ours.radiance[i]);
  }
  return explainLostScene(scene, ours, theirs, reference);
}

TEST(ExplainLostScene, SaysWhereTheErrorIs) {
  using Eigen::Vector3d;
  const auto expectSays = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expectSays(explained([](double z, bool dark, Vector3d& v) { v *= !dark && z > 0.4 ? 0.9 : 1.0; }),
             "100 % is too dark, 0 % seen beyond 70 degrees, 0 % in pixels");
  expectSays(explained([](double z, bool dark, Vector3d& v) { v *= !dark && z > 0.4 ? 1.1 : 1.0; }),
             "100 % is too bright, 0 % seen beyond");
  expectSays(explained([](double, bool dark, Vector3d& v) { v *= dark ? 3.0 : 1.0; }),
             "100 % in pixels below 2 %");
  expectSays(explained([](double z, bool dark, Vector3d& v) { v *= !dark && z < 0.34 ? 1.1 : 1.0; }),
             "100 % seen beyond 70 degrees");
  expectSays(explained([](double, bool, Vector3d& v) { v *= 1.000102; }), "hardly");
}

}  // namespace
}  // namespace ltcfit
