// Chi-square tests of the samplers. Directions are binned by where their half vector lies in the
// configuration of roughness 1, by the cosine s_z and azimuth: there every lobe is spread out, whatever its
// alpha.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "ggx/ggx_lobe.h"
#include "ggx/moments.h"
#include "ggx/random.h"
#include "tests/support/chi_square.h"

namespace ltcfit {
namespace {

using Eigen::Vector3d;
using Density = std::function<double(const Vector3d& wi)>;
using Sampler = std::function<std::optional<Vector3d>(Random&)>;

constexpr double kPi = std::numbers::pi;
constexpr int kRings = 10;
constexpr int kSectors = 16;
constexpr int kSamples = 100000;

struct Case {
  double theta;  // degrees
  double phi;
  GgxAlpha alpha;
};

std::vector<Case> allCases() {
  std::vector<Case> cases;
  for (const GgxAlpha alpha :
       {GgxAlpha{1e-4, 1e-4}, GgxAlpha{1e-3, 1e-3}, GgxAlpha{0.02, 0.02}, GgxAlpha{0.3, 0.3},
        GgxAlpha{1.0, 1.0}, GgxAlpha{0.5, 0.005}, GgxAlpha{0.005, 0.5}}) {
    for (double theta : {0.0, 45.0, 80.0, 89.0, 90.0}) {
      for (double phi : {0.0, 0.65}) cases.push_back({theta, phi, alpha});
    }
  }
  return cases;
}

GgxLobe lobeOf(const Case& c) {
  return GgxLobe(viewDirection(c.theta * kPi / 180.0, c.phi), c.alpha);
}

std::size_t binOf(double sz, double azimuth) {
  const int ring = std::clamp(static_cast<int>(sz * kRings), 0, kRings - 1);
  const int sector = std::min(kSectors - 1, static_cast<int>(azimuth / (2.0 * kPi) * kSectors));
  return static_cast<std::size_t>(ring * kSectors + sector);
}

std::size_t binOf(const GgxLobe& lobe, const Vector3d& wi) {
  const Vector3d h = lobe.wo() + wi;
  const Vector3d s = Vector3d(h.x() / lobe.alpha().x, h.y() / lobe.alpha().y, h.z()).normalized();
  double azimuth = std::atan2(s.y(), s.x());
  if (azimuth < 0.0) azimuth += 2.0 * kPi;
  return binOf(s.z(), azimuth);
}

// Integral of the density over every bin, by the midpoint rule on a fine grid of the hemisphere of s. There
// D wm.z dwm = s_z ds / pi, and dwi = 4 wo.wm dwm.
std::vector<double> binMasses(const GgxLobe& lobe, const Density& density) {
  constexpr int kFine = 24;
  std::vector<double> mass(kRings * kSectors, 0.0);
  const int rings = kRings * kFine;
  const int sectors = kSectors * kFine;
  for (int i = 0; i < rings; ++i) {
    const double sz = (i + 0.5) / rings;
    for (int j = 0; j < sectors; ++j) {
      const double azimuth = 2.0 * kPi * (j + 0.5) / sectors;
      const double r = std::sqrt(1.0 - sz * sz);
      const Vector3d wm =
          Vector3d(lobe.alpha().x * r * std::cos(azimuth), lobe.alpha().y * r * std::sin(azimuth), sz)
              .normalized();
      const double cosine = lobe.wo().dot(wm);
      if (cosine <= 0.0) continue;
      const Vector3d wi = 2.0 * cosine * wm - lobe.wo();
      const double area = 2.0 * kPi / (static_cast<double>(rings) * sectors);
      mass[binOf(sz, azimuth)] +=
          density(wi) * 4.0 * cosine * sz / (ggxD(wm, lobe.alpha()) * wm.z()) * area / kPi;
    }
  }
  return mass;
}

// Deviations of the sampler from the density; the density must integrate to 1 by itself.
double deviations(const GgxLobe& lobe, const Density& density, const Sampler& sampler, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> observed(kRings * kSectors, 0.0);
  double n = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    if (const std::optional<Vector3d> wi = sampler(random)) {
      observed[binOf(lobe, *wi)] += 1.0;
      n += 1.0;
    }
  }
  std::vector<double> expected = binMasses(lobe, density);
  double total = 0.0;
  for (double& e : expected) {
    total += e;
    e *= n;
  }
  EXPECT_NEAR(total, 1.0, 2e-3) << "the density is not normalised";  // the grid's error at the horizon
  return test::chiSquareDeviations(observed, expected);
}

Sampler rejection(const GgxLobe& lobe) {
  return [&lobe](Random& random) {
    const Eigen::Vector2d u(random.uniform(), random.uniform());
    return lobe.sampleByRejection(u, random.uniform());
  };
}

// KT et al. 2022, section 3.1 and Algorithm 1, as printed: (1 + Lambda(wi)) / (1 + Lambda(wo) + Lambda(wi)).
Sampler misprintedRejection(const GgxLobe& lobe) {
  return [&lobe](Random& random) -> std::optional<Vector3d> {
    const LobeSample s = lobe.sample({random.uniform(), random.uniform()});
    if (s.wi.z() <= 0.0) return std::nullopt;
    const double lo = ggxLambda(lobe.wo(), lobe.alpha());
    const double li = ggxLambda(s.wi, lobe.alpha());
    if (random.uniform() < (1.0 + li) / (1.0 + lo + li)) return s.wi;
    return std::nullopt;
  };
}

Density normalisedBrdf(const GgxLobe& lobe) {
  const double albedo = computeMoments(lobe).albedo;
  return [&lobe, albedo](const Vector3d& wi) { return lobe.eval(wi) / albedo; };
}

TEST(Sampling, VisibleNormalsHaveTheirDensity) {
  const std::vector<Case> cases = allCases();
  const double threshold = test::sidakThreshold(static_cast<int>(cases.size()));
  std::uint64_t seed = 100;
  for (const Case& c : cases) {
    const GgxLobe lobe = lobeOf(c);
    const double d = deviations(
        lobe, [&](const Vector3d& wi) { return lobe.pdf(wi); },
        [&](Random& random) {
          return std::optional(lobe.sample({random.uniform(), random.uniform()}).wi);
        },
        ++seed);
    EXPECT_LT(d, threshold) << "theta " << c.theta << " phi " << c.phi << " alpha " << c.alpha.x << " "
                            << c.alpha.y;
  }
}

TEST(Sampling, RejectionGivesTheBrdf) {
  const std::vector<Case> cases = allCases();
  const double threshold = test::sidakThreshold(static_cast<int>(cases.size()));
  std::uint64_t seed = 200;
  for (const Case& c : cases) {
    const GgxLobe lobe = lobeOf(c);
    const double d = deviations(lobe, normalisedBrdf(lobe), rejection(lobe), ++seed);
    EXPECT_LT(d, threshold) << "theta " << c.theta << " phi " << c.phi << " alpha " << c.alpha.x << " "
                            << c.alpha.y;
  }
}

TEST(Sampling, TheMisprintedWeightIsCaught) {
  // Away from normal view and from smooth surfaces, where both weights tend to 1, the test must see it.
  for (const Case& c :
       {Case{45.0, 0.0, {1.0, 1.0}}, Case{80.0, 0.0, {0.3, 0.3}}, Case{89.0, 0.65, {0.3, 0.3}},
        Case{80.0, 0.65, {0.5, 0.005}}, Case{89.0, 0.0, {0.02, 0.02}}}) {
    const GgxLobe lobe = lobeOf(c);
    EXPECT_GT(deviations(lobe, normalisedBrdf(lobe), misprintedRejection(lobe), 300), 10.0)
        << "theta " << c.theta << " alpha " << c.alpha.x;
  }
}

TEST(Sampling, WithoutRejectionItIsNotTheBrdf) {
  const Case c{80.0, 0.0, {0.3, 0.3}};
  const GgxLobe lobe = lobeOf(c);
  const Sampler all = [&lobe](Random& random) -> std::optional<Vector3d> {
    const LobeSample s = lobe.sample({random.uniform(), random.uniform()});
    return s.wi.z() > 0.0 ? std::optional(s.wi) : std::nullopt;
  };
  EXPECT_GT(deviations(lobe, normalisedBrdf(lobe), all, 400), 10.0);
}

}  // namespace
}  // namespace ltcfit
