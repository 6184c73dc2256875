#include "tailor/verification.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/parallel_for.h"
#include "fit/target_lobe.h"
#include "ggx/random.h"
#include "render/picture_error.h"
#include "render/reference.h"
#include "render/scenes.h"
#include "render/twin.h"
#include "report/metrics.h"

namespace ltcfit {
namespace {

constexpr std::array<Metric, 3> kLightMetrics{Metric::kLightS, Metric::kLightM, Metric::kLightL};

void addTruth(const Table& tailored, const Table& full, const LobeDistribution& distribution,
              const InterpolationModelOptions& fit, const VerificationOptions& options, Verification* out) {
  const std::vector<LookUp> lookUps =
      drawLookUps(distribution, options.truthPoints, fit.alphaFloor, mixSeed(options.seed, 2));
  std::vector<std::array<LightErrors, 3>> errors(lookUps.size());
  std::vector<char> usable(lookUps.size(), 0);
  parallelFor(lookUps.size(), {.threads = fit.threads}, [&](std::size_t i) {
    const LobeParameters& p = lookUps[i].parameters;
    const StoredEntry direct = fitLookUp(p, distribution.isotropic, fit);
    const TableEntry a = tailored.fetch(p);
    const TableEntry b = full.fetch(p);
    if (direct.allFinite() && a.invertible && b.invertible) {
      const std::unique_ptr<Lobe> lobe = makeTargetLobe(fit.brdf, p);
      MetricOptions metrics;
      metrics.samples = 64;  // of figures that are not asked for here
      metrics.directions = 1;
      metrics.quads = 1;
      metrics.seed = mixSeed(options.seed, 1000 + i);
      const MetricTarget target(*lobe, metrics);
      const std::array<Eigen::Matrix3d, 3> matrices{matrixOf(direct, lookUpStorage(distribution.isotropic)),
                                                    a.m, b.m};
      for (std::size_t k = 0; k < 3; ++k) {
        const EntryMetrics found = target.evaluate(Ltc(matrices[k]));
        for (std::size_t m = 0; m < 3; ++m) errors[i][k][m] = found.get(kLightMetrics[m]);
      }
      usable[i] = 1;
    }
  });
  double count = 0.0;
  for (char u : usable) count += u;
  if (count == 0.0) return;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    for (std::size_t m = 0; m < 3; ++m) {
      out->directLight[m] += errors[i][0][m] / count;
      out->tailoredLight[m] += errors[i][1][m] / count;
      out->fullLight[m] += errors[i][2][m] / count;
    }
  }
}

// The table with amplitudes of 0 for those that it does not have, which the twin multiplies by 0.
Table completed(const Table& table) {
  TableInfo info = table.info();
  const auto has = [&info](const char* name) {
    return std::find(info.channels.begin(), info.channels.end(), name) != info.channels.end();
  };
  const std::size_t channels = info.channels.size();
  for (const char* const name : {"norm", "fresnel"})
    if (!has(name)) info.channels.emplace_back(name);
  std::vector<float> data;
  for (std::size_t i = 0; i < table.nodeCount(); ++i) {
    for (std::size_t c = 0; c < info.channels.size(); ++c)
      data.push_back(c < channels ? table.data()[i * channels + c] : 0.0f);
  }
  return Table(std::move(info), std::move(data));
}

// Pixels whose view is outside of the range count as no surface: the table is not for them.
void maskViews(const Scene& scene, const ViewUse& views, Film* film) {
  for (std::size_t row = 0; row < film->height; ++row) {
    for (std::size_t column = 0; column < film->width; ++column) {
      const PixelView view = viewPixel(scene, column, row);
      if (view.kind != PixelKind::kSurface) continue;
      const double theta = std::acos(std::clamp(view.point.wo.z(), 0.0, 1.0));
      if (theta < views.low || theta > views.high)
        film->kinds[row * film->width + column] = PixelKind::kBackground;
    }
  }
}

void addScenes(const Table& tailored, const Table& full, const LobeDistribution& distribution, double bound,
               const InterpolationModelOptions& fit, const VerificationOptions& options, Verification* out) {
  const std::vector<LookUp> lookUps =
      drawLookUps(distribution, options.scenes, fit.alphaFloor, mixSeed(options.seed, 3));
  const Table tailoredTwin = completed(tailored);
  const Table fullTwin = completed(full);
  const bool fresnel = tailoredTwin.channelCount() == tailored.channelCount();
  for (std::size_t i = 0; i < options.scenes; ++i) {
    Scene scene = randomScene(options.seed, i, !distribution.isotropic, options.pixels);
    for (Surface& surface : scene.surfaces) {
      Material& m = surface.material;
      const bool swapped = m.alpha.y() > m.alpha.x();
      m.alpha = {lookUps[i].parameters.alphaX, lookUps[i].parameters.alphaY};
      if (swapped) m.alpha.reverseInPlace();
      m.f0 = fresnel ? lookUps[i].f0 : lookUps[i].f0 > 0.0 ? 1.0 : 0.0;
    }
    ReferenceOptions reference;
    reference.seed = mixSeed(options.seed, 4);
    reference.maxSamples = 1 << 14;
    reference.threads = fit.threads;
    ReferenceFilm truth = renderReference(scene, reference);
    maskViews(scene, distribution.views, &truth.film);
    if (std::count(truth.film.kinds.begin(), truth.film.kinds.end(), PixelKind::kSurface) == 0) continue;
    TwinOptions twin;
    twin.threads = fit.threads;
    const double a = pictureError(renderTwin(scene, tailoredTwin, twin), truth.film).rmse;
    const double b = pictureError(renderTwin(scene, fullTwin, twin), truth.film).rmse;
    ++out->scenes;
    out->tailoredRmse += a;
    out->fullRmse += b;
    out->referenceRmse += truth.ownRmse;
    out->worseScenes += a > b + bound ? 1 : 0;
  }
  if (out->scenes == 0) return;
  const auto n = static_cast<double>(out->scenes);
  out->tailoredRmse /= n;
  out->fullRmse /= n;
  out->referenceRmse /= n;
}

}  // namespace

Verification verifyTable(const Table& tailored, const Table& full, const LobeDistribution& distribution,
                         double bound, const InterpolationModelOptions& fit,
                         const VerificationOptions& options, const FitProgress& progress) {
  const FetchCheck check(distribution, options.lookUps, fit, mixSeed(options.seed, 1), progress);
  Verification out;
  out.tailored = check.measure(tailored);
  out.full = check.measure(full);
  addTruth(tailored, full, distribution, fit, options, &out);
  addScenes(tailored, full, distribution, bound, fit, options, &out);
  return out;
}

}  // namespace ltcfit
