#include "report/lobe_images.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "fit/target_lobe.h"
#include "ggx/moments.h"
#include "ltc/ltc.h"
#include "report/colors.h"

namespace ltcfit {
namespace {

constexpr double kWindowSpreads = 1.5;
constexpr int kSubPixels = 3;
constexpr Rgb kHorizonOnDensity{255, 255, 255};
constexpr Rgb kHorizonOnDifference{40, 40, 40};

using Density = std::function<double(const Eigen::Vector3d&)>;

// Of picture coordinate `pixel`, in pixels from the upper or left edge.
double toWindow(double pixel) {
  return 2.0 * pixel / static_cast<double>(kPicturePixels) - 1.0;
}

struct PixelPlace {
  double column;
  double row;
};
PixelPlace placeOf(std::size_t pixel) {
  const std::size_t row = pixel / kPicturePixels;
  return {static_cast<double>(pixel % kPicturePixels), static_cast<double>(row)};
}

Eigen::Vector3d directionAt(const LobeWindow& window, double column, double row) {
  return window.direction(toWindow(column), -toWindow(row));
}

std::vector<double> meanDensities(const LobeWindow& window, const Density& density) {
  std::vector<double> out;
  out.reserve(kPicturePixels * kPicturePixels);
  for (std::size_t pixel = 0; pixel < kPicturePixels * kPicturePixels; ++pixel) {
    const auto [column, row] = placeOf(pixel);
    double sum = 0.0;
    for (int y = 0; y < kSubPixels; ++y) {
      for (int x = 0; x < kSubPixels; ++x)
        sum += density(directionAt(window, column + (x + 0.5) / kSubPixels, row + (y + 0.5) / kSubPixels));
    }
    out.push_back(sum / (kSubPixels * kSubPixels));
  }
  return out;
}

// Whether the horizon passes between this pixel's middle and that of the next one to the right or below.
bool onHorizon(const LobeWindow& window, double column, double row) {
  const bool above = directionAt(window, column + 0.5, row + 0.5).z() > 0.0;
  return above != (directionAt(window, column + 1.5, row + 0.5).z() > 0.0) ||
         above != (directionAt(window, column + 0.5, row + 1.5).z() > 0.0);
}

template <typename Color>
Picture painted(const LobeWindow& window, const std::vector<double>& values, Color color,
                const Rgb& horizon) {
  Picture out{kPicturePixels, kPicturePixels, {}};
  out.rgb.reserve(3 * values.size());
  for (std::size_t pixel = 0; pixel < values.size(); ++pixel) {
    const auto [column, row] = placeOf(pixel);
    const Rgb c = onHorizon(window, column, row) ? horizon : color(values[pixel]);
    out.rgb.insert(out.rgb.end(), c.begin(), c.end());
  }
  return out;
}

}  // namespace

Eigen::Vector3d LobeWindow::direction(double x, double y) const {
  const double radius = std::hypot(x, y);
  if (radius == 0.0) return centre;
  const double angle = halfWidth * radius;
  return std::cos(angle) * centre + std::sin(angle) / radius * (x * right + y * up);
}

LobeWindow lobeWindow(const Eigen::Vector3d& mean, double spread, const Eigen::Vector3d& wo) {
  LobeWindow window;
  window.centre = mean.normalized();
  const auto across = [&](const Eigen::Vector3d& v) {
    return Eigen::Vector3d(v - v.dot(window.centre) * window.centre);
  };
  constexpr double kTooShort = 1e-3;  // closer to the normal than this, "up" would be rounding noise
  Eigen::Vector3d up = across(Eigen::Vector3d::UnitZ());
  if (up.norm() < kTooShort) up = across(wo);
  if (up.norm() < kTooShort) up = across(Eigen::Vector3d::UnitX());
  window.up = up.normalized();
  window.right = window.up.cross(window.centre);
  window.halfWidth = std::min(kWindowSpreads * spread, 0.5 * std::numbers::pi);
  return window;
}

LobePictures drawLobe(std::string_view brdf, const LobeParameters& parameters,
                      const std::vector<TableEntry>& entries) {
  const std::unique_ptr<Lobe> lobe = makeTargetLobe(brdf, parameters);
  const LobeMoments moments = computeMoments(*lobe);
  LobePictures out;
  out.window = lobeWindow(moments.mean, moments.spread, lobe->wo());
  const std::vector<double> truth =
      meanDensities(out.window, [&](const Eigen::Vector3d& w) { return lobe->eval(w) / moments.albedo; });
  out.peak = *std::max_element(truth.begin(), truth.end());
  std::vector<std::vector<double>> densities(entries.size());
  for (std::size_t t = 0; t < entries.size(); ++t) {
    if (!entries[t].invertible) continue;
    const Ltc ltc(entries[t].m);
    densities[t] = meanDensities(out.window, [&](const Eigen::Vector3d& w) { return ltc.density(w); });
    for (std::size_t i = 0; i < truth.size(); ++i)
      out.difference = std::max(out.difference, std::abs(densities[t][i] - truth[i]));
  }
  out.difference = std::min(out.difference, out.peak);
  const auto density = [&](double v) { return densityColor(v / out.peak); };
  const auto difference = [&](double v) {
    return differenceColor(out.difference > 0.0 ? v / out.difference : 0.0);
  };
  out.lobe = painted(out.window, truth, density, kHorizonOnDensity);
  for (std::vector<double>& values : densities) {
    out.tables.emplace_back();
    if (values.empty()) continue;
    LobePictures::Ltc pictures{painted(out.window, values, density, kHorizonOnDensity), {}};
    std::transform(values.begin(), values.end(), truth.begin(), values.begin(), std::minus<>());
    pictures.difference = painted(out.window, values, difference, kHorizonOnDifference);
    out.tables.back() = std::move(pictures);
  }
  return out;
}

}  // namespace ltcfit
