// Which texels triangles show.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "ggx/random.h"
#include "scene/uv_coverage.h"

namespace ltcfit {
namespace {

using Triangle = std::array<std::array<double, 2>, 3>;
using Texels = std::set<std::pair<std::size_t, std::size_t>>;  // x, y

Texels covered(const UvCoverage& coverage, std::size_t width) {
  Texels out;
  for (std::size_t i = 0; i < coverage.areas().size(); ++i)
    if (coverage.areas()[i] > 0.0f) out.insert({i % width, i / width});
  return out;
}

double total(const UvCoverage& coverage) {
  double sum = 0.0;
  for (const float area : coverage.areas()) sum += static_cast<double>(area);
  return sum;
}

std::size_t wrapped(std::ptrdiff_t i, std::size_t size, Wrap wrap) {
  const auto n = static_cast<std::ptrdiff_t>(size);
  if (wrap == Wrap::kClamp) return static_cast<std::size_t>(std::min(std::max<std::ptrdiff_t>(i, 0), n - 1));
  const std::ptrdiff_t period = wrap == Wrap::kMirror ? 2 * n : n;
  const std::ptrdiff_t k = ((i % period) + period) % period;
  return static_cast<std::size_t>(k < n ? k : period - 1 - k);
}

// What bilinear filtering reads at many points of the triangle.
Texels sampled(const Triangle& t, std::size_t width, std::size_t height, Wrap u, Wrap v) {
  Texels out;
  constexpr int kSteps = 60;
  for (int a = 0; a <= kSteps; ++a)
    for (int b = 0; a + b <= kSteps; ++b) {
      std::array<double, 2> p{};
      for (std::size_t i = 0; i < 2; ++i)
        p[i] = (a * t[0][i] + b * t[1][i] + (kSteps - a - b) * t[2][i]) / kSteps;
      const double x = p[0] * static_cast<double>(width) - 0.5;
      const double y = p[1] * static_cast<double>(height) - 0.5;
      // texels of weight 0 are not read
      for (const double i : {std::floor(x), std::ceil(x)})
        for (const double j : {std::floor(y), std::ceil(y)})
          out.insert({wrapped(static_cast<std::ptrdiff_t>(i), width, u),
                      wrapped(static_cast<std::ptrdiff_t>(j), height, v)});
    }
  return out;
}

TEST(UvCoverage, PointReadsFourTexels) {
  UvCoverage coverage(8, 8, Wrap::kRepeat, Wrap::kRepeat);
  coverage.add({{{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}}}, 2.0);
  EXPECT_EQ(covered(coverage, 8), (Texels{{3, 3}, {3, 4}, {4, 3}, {4, 4}}));
  EXPECT_FLOAT_EQ(coverage.areas()[3 * 8 + 3], 0.5f);
  UvCoverage centre(8, 8, Wrap::kRepeat, Wrap::kRepeat);
  centre.add({{{0.5625, 0.5625}, {0.5625, 0.5625}, {0.5625, 0.5625}}}, 2.0);
  EXPECT_EQ(covered(centre, 8), (Texels{{4, 4}}));
}

TEST(UvCoverage, EdgesWrap) {
  const Triangle corner{{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}}};
  UvCoverage repeat(4, 4, Wrap::kRepeat, Wrap::kClamp);
  repeat.add(corner, 1.0);
  EXPECT_EQ(covered(repeat, 4), (Texels{{3, 0}, {0, 0}}));
  UvCoverage mirror(4, 4, Wrap::kMirror, Wrap::kMirror);
  mirror.add(corner, 1.0);
  EXPECT_EQ(covered(mirror, 4), (Texels{{0, 0}}));
  const Triangle beyond{{{1.25, 2.3}, {1.3, 2.4}, {1.3, 2.3}}};
  UvCoverage clamp(4, 4, Wrap::kClamp, Wrap::kClamp);
  clamp.add(beyond, 1.0);
  EXPECT_EQ(covered(clamp, 4), (Texels{{3, 3}}));
}

TEST(UvCoverage, RepeatedTextureIsCoveredWhole) {
  UvCoverage coverage(4, 4, Wrap::kRepeat, Wrap::kMirror);
  coverage.add({{{0, 0}, {100, 0}, {0, 100}}}, 1.0);
  EXPECT_EQ(covered(coverage, 4).size(), 16u);
  EXPECT_NEAR(total(coverage), 1.0, 1e-6);  // float
  EXPECT_LE(coverage.work(), 16u);
}

TEST(UvCoverage, CoordinatesThatAreNoNumbersCoverAll) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e30}) {
    UvCoverage coverage(4, 4, Wrap::kClamp, Wrap::kRepeat);
    coverage.add({{{0, 0}, {bad, 0}, {0, 1}}}, 1.0);
    EXPECT_EQ(covered(coverage, 4).size(), 16u) << bad;
  }
}

TEST(UvCoverage, NothingThatIsReadIsMissed) {
  Random random(3);
  const auto number = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  const std::array<Wrap, 3> kWraps{Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp};
  std::size_t extra = 0;
  std::size_t all = 0;
  for (int n = 0; n < 600; ++n) {
    const std::size_t width = 1 + static_cast<std::size_t>(number(0.0, 20.0));
    const std::size_t height = 1 + static_cast<std::size_t>(number(0.0, 20.0));
    const Wrap u = kWraps[static_cast<std::size_t>(n % 3)];
    const Wrap v = kWraps[static_cast<std::size_t>(n / 3 % 3)];
    const double size = n % 2 == 0 ? 0.3 : 1.7;
    const double x = number(-2.0, 2.0);
    const double y = number(-2.0, 2.0);
    Triangle triangle{};
    for (auto& point : triangle) point = {x + size * random.uniform(), y + size * random.uniform()};
    UvCoverage coverage(width, height, u, v);
    coverage.add(triangle, 1.0);
    const Texels found = covered(coverage, width);
    const Texels needed = sampled(triangle, width, height, u, v);
    for (const auto& texel : needed)
      EXPECT_TRUE(found.contains(texel)) << n << ": " << texel.first << " " << texel.second;
    EXPECT_NEAR(total(coverage), 1.0, 1e-5);  // float
    // those that do not repeat
    if (n % 2 != 0) continue;
    extra += found.size() - needed.size();
    all += found.size();
  }
  // what the samples miss at corners
  EXPECT_LT(static_cast<double>(extra), 0.02 * static_cast<double>(all));
}

}  // namespace
}  // namespace ltcfit
