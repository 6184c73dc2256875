#include "render/prefilter.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "base/parallel_for.h"
#include "base/refusal.h"

namespace ltcfit {
namespace {

constexpr double kSupport = 6.0;  // sigmas: what is beyond would change the eighth digit
// Levels by which an image that the margin is blended from is finer than its own: a quarter of its sigma from
// texel to texel, which a bilinear look-up sees as smooth (0.2 % of an edge's height).
constexpr std::size_t kFinerLevels = 3;
constexpr std::size_t kMaxSize = 4096;
constexpr std::size_t kParallelSize = 64;  // below it threads cost more than they bring

// What each texel along one axis counts.
struct Weights {
  std::size_t first = 0;
  Eigen::VectorXd values;
};

// Of exp(-x^2) / sqrt(pi), without cancellation in its tails.
double massBetween(double a, double b) {
  if (a >= 0.0) return 0.5 * (std::erfc(a) - std::erfc(b));
  if (b <= 0.0) return 0.5 * (std::erfc(-b) - std::erfc(-a));
  return 0.5 * (std::erf(b) - std::erf(a));
}

// For a Gaussian around `centre`, in [0, 1] alone, and values that are linear between the centres of texels
// and constant beyond the first and the last.
Weights weightsAt(double centre, double sigma, std::size_t count) {
  const auto n = static_cast<double>(count);
  const auto knot = [&](std::size_t j) {
    return j == 0 ? 0.0 : j == count + 1 ? 1.0 : (static_cast<double>(j) - 0.5) / n;
  };
  // from outside, the weight falls from the edge on, faster than from the centre
  const double edge = std::clamp(centre, 0.0, 1.0);
  const auto segment = [&](double t) {
    return static_cast<std::size_t>(std::lround(std::clamp(t, 0.0, 1.0) * n));
  };
  const std::size_t from = segment(edge - kSupport * sigma);
  const std::size_t to = segment(edge + kSupport * sigma);
  Weights weights;
  weights.first = from == 0 ? 0 : from - 1;
  weights.values.setZero(static_cast<Eigen::Index>(std::min(to, count - 1) - weights.first + 1));
  const auto scaled = [&](double t) { return (t - centre) / (sigma * std::numbers::sqrt2); };
  // sigma^2 times the Gaussian, whose difference is the integral of t - centre under it, the sign turned
  const auto density = [&](double x) { return std::exp(-x * x) * sigma / std::sqrt(2.0 * std::numbers::pi); };
  for (std::size_t j = from; j <= to; ++j) {
    const double a = knot(j);
    const double b = knot(j + 1);
    const double mass = massBetween(scaled(a), scaled(b));
    const double moment = density(scaled(a)) - density(scaled(b)) + (centre - a) * mass;
    const double right = std::clamp(moment / (b - a), 0.0, mass);
    weights.values[static_cast<Eigen::Index>((j == 0 ? 0 : j - 1) - weights.first)] += mass - right;
    weights.values[static_cast<Eigen::Index>(std::min(j, count - 1) - weights.first)] += right;
  }
  const double sum = weights.values.sum();
  if (sum > 0.0) {
    weights.values /= sum;
  } else {  // so far outside that all of it underflows
    weights.values.setZero();
    weights.values[edge > 0.5 ? weights.values.size() - 1 : 0] = 1.0;
  }
  return weights;
}

// How the rows of an image are shared among threads.
ParallelOptions rowsOf(std::size_t size, int threads) {
  return {.threads = size >= kParallelSize ? threads : 1, .chunk = 4};
}

class Filter {
 public:
  Filter(const LightTexture& picture, const PrefilterOptions& options)
      : picture_(picture),
        margin_(options.margin),
        root_(std::sqrt(options.aspect)),
        threads_(options.threads) {}

  double coordinate(std::size_t i, std::size_t size) const {
    return (static_cast<double>(i) + 0.5) / static_cast<double>(size) * (1.0 + 2.0 * margin_) - margin_;
  }

  PrefilteredLevel level(std::size_t size, double sigma) const {
    std::vector<Weights> across(size);
    std::vector<Weights> down(size);
    for (std::size_t i = 0; i < size; ++i) {
      across[i] = weightsAt(coordinate(i, size), sigma / root_, picture_.width);
      down[i] = weightsAt(coordinate(i, size), sigma * root_, picture_.height);
    }
    PrefilteredLevel out{size, std::vector<Eigen::Vector3d>(size * size)};
    const auto width = static_cast<Eigen::Index>(picture_.width);
    parallelFor(size, rowsOf(size, threads_), [&](std::size_t y) {
      Eigen::Matrix3Xd row = Eigen::Matrix3Xd::Zero(3, width);
      for (Eigen::Index r = 0; r < down[y].values.size(); ++r) {
        const Eigen::Vector3d* const from =
            &picture_.texels[(down[y].first + static_cast<std::size_t>(r)) * picture_.width];
        row += down[y].values[r] * Eigen::Map<const Eigen::Matrix3Xd>(from->data(), 3, width);
      }
      for (std::size_t x = 0; x < size; ++x) {
        const Weights& w = across[x];
        out.texels[y * size + x] =
            row.middleCols(static_cast<Eigen::Index>(w.first), w.values.size()) * w.values;
      }
    });
    return out;
  }

  double distance(double u, double v) const {
    return std::hypot((u - std::clamp(u, 0.0, 1.0)) * root_, (v - std::clamp(v, 0.0, 1.0)) / root_);
  }

 private:
  const LightTexture& picture_;
  double margin_;
  double root_;
  int threads_;
};

// The bilinear look-up is itself a filter, of variance 1/6 of a squared texel.
double finestSigma(std::size_t size, const PrefilterOptions& options) {
  const double texel = (1.0 + 2.0 * options.margin) / static_cast<double>(size);
  const double own = kPrefilterSigma * kPrefilterSigma;
  return texel * std::pow((own / options.aspect + 1.0 / 6.0) * (own * options.aspect + 1.0 / 6.0), 0.25);
}

}  // namespace

std::size_t prefilteredSize(const LightTexture& picture, const PrefilterOptions& options) {
  if (picture.width == 0 || picture.height == 0 || picture.texels.size() != picture.width * picture.height)
    throw Refusal("the picture has no texels, or not as many as its size says");
  if (!(options.margin >= 0.0 && options.margin <= 4.0))
    throw Refusal(fmt::format("margin {}: need 0 to 4", options.margin));
  if (!(options.spread >= 0.1 && options.spread <= 10.0))
    throw Refusal(fmt::format("spread {}: need 0.1 to 10", options.spread));
  if (!(options.aspect >= 1.0 / 64.0 && options.aspect <= 64.0))
    throw Refusal(fmt::format("aspect {}: need 1/64 to 64", options.aspect));
  if (options.size == 0) {
    const auto along = static_cast<double>(std::max(picture.width, picture.height));
    const auto wanted = static_cast<std::size_t>(std::ceil(along * (1.0 + 2.0 * options.margin) - 1e-9));
    return std::clamp<std::size_t>(std::bit_ceil(wanted), 4, kMaxSize);
  }
  if (!std::has_single_bit(options.size) || options.size < 4 || options.size > kMaxSize)
    throw Refusal(fmt::format("size {}: need a power of two from 4 to {}", options.size, kMaxSize));
  return options.size;
}

Eigen::Vector3d bilinear(const PrefilteredLevel& level, double x, double y) {
  const auto last = static_cast<double>(level.size - 1);
  x = std::clamp(x, 0.0, last);
  y = std::clamp(y, 0.0, last);
  const auto x0 = static_cast<std::size_t>(x);
  const auto y0 = static_cast<std::size_t>(y);
  const std::size_t x1 = std::min(x0 + 1, level.size - 1);
  const std::size_t y1 = std::min(y0 + 1, level.size - 1);
  const double fx = x - static_cast<double>(x0);
  const double fy = y - static_cast<double>(y0);
  const auto at = [&](std::size_t column, std::size_t row) -> const Eigen::Vector3d& {
    return level.texels[row * level.size + column];
  };
  return (1.0 - fy) * ((1.0 - fx) * at(x0, y0) + fx * at(x1, y0)) +
         fy * ((1.0 - fx) * at(x0, y1) + fx * at(x1, y1));
}

double lodOfSigma(const PrefilteredTexture& texture, double sigma) {
  return std::log2(texture.lodScale * sigma);
}

double sigmaOfLod(const PrefilteredTexture& texture, double lod) {
  return std::exp2(lod) / texture.lodScale;
}

PrefilteredTexture prefilter(const LightTexture& picture, const PrefilterOptions& options) {
  const std::size_t size = prefilteredSize(picture, options);
  const Filter filter(picture, options);
  const double finest = kPrefilterSigma * (1.0 + 2.0 * options.margin) / static_cast<double>(size);
  const auto count = static_cast<std::size_t>(std::bit_width(size));
  const auto sigmaOf = [&](std::size_t level) { return std::ldexp(finest, static_cast<int>(level)); };

  PrefilteredTexture out;
  out.margin = options.margin;
  out.aspect = options.aspect;
  out.lodScale = 1.0 / finestSigma(size, options);
  for (std::size_t k = 0; k < count; ++k) out.levels.push_back(filter.level(size >> k, sigmaOf(k)));

  // Level that a texel's own sigma belongs to: k inside the picture, a fraction above it in the margin.
  const auto ownLevel = [&](std::size_t k, std::size_t x, std::size_t y) {
    const std::size_t n = out.levels[k].size;
    const double spread = options.spread * filter.distance(filter.coordinate(x, n), filter.coordinate(y, n));
    const double rise = 0.5 * std::log2(1.0 + spread * spread / (sigmaOf(k) * sigmaOf(k)));
    return std::min(static_cast<double>(k) + rise, static_cast<double>(count - 1));
  };
  for (std::size_t j = 0; j < count; ++j) {
    const PrefilteredLevel image =
        j == 0 ? PrefilteredLevel{} : filter.level(size >> (j - std::min(j, kFinerLevels)), sigmaOf(j));
    for (std::size_t k = 0; k <= j; ++k) {
      PrefilteredLevel& level = out.levels[k];
      const double scale = static_cast<double>(image.size) / static_cast<double>(level.size);
      parallelFor(level.size, rowsOf(level.size, options.threads), [&](std::size_t y) {
        for (std::size_t x = 0; x < level.size; ++x) {
          const double weight = 1.0 - std::abs(ownLevel(k, x, y) - static_cast<double>(j));
          Eigen::Vector3d& texel = level.texels[y * level.size + x];
          if (j == k) {
            texel *= std::max(weight, 0.0);
          } else if (weight > 0.0) {
            texel += weight * bilinear(image, (static_cast<double>(x) + 0.5) * scale - 0.5,
                                       (static_cast<double>(y) + 0.5) * scale - 0.5);
          }
        }
      });
    }
  }
  return out;
}

}  // namespace ltcfit
