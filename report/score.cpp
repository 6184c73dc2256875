#include "report/score.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>

#include "base/diagnostics.h"
#include "base/parallel_for.h"
#include "fit/entry_fit.h"
#include "fit/sliced_wasserstein_fit.h"
#include "fit/table_fit.h"
#include "fit/table_plan.h"
#include "fit/target_lobe.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;

struct PointResult {
  LobeParameters parameters;
  EntryMetrics metrics;
  bool singular = false;
  bool singularFloat32 = false;
  bool otherParameters = false;
};

bool sameLayout(const Table& a, const Table& b) {
  for (std::size_t i = 0; i < a.info().axes.size(); ++i) {
    const Axis& x = a.info().axes[i];
    const Axis& y = b.info().axes[i];
    if (x.size() != y.size() || x.map != y.map || x.low != y.low || x.high != y.high || x.warp != y.warp)
      return false;
  }
  return true;
}

bool sameParameters(const LobeParameters& a, const LobeParameters& b) {
  return a.alphaX == b.alphaX && a.alphaY == b.alphaY && a.theta == b.theta && a.phi == b.phi;
}

// The target of one set of parameters. Not copyable: the metrics keep a reference to the lobe.
struct Target {
  Target(const std::string& brdf, const LobeParameters& p, const MetricOptions& options)
      : parameters(p), lobe(makeTargetLobe(brdf, p)), metrics(*lobe, options) {}
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  LobeParameters parameters;
  std::unique_ptr<Lobe> lobe;
  MetricTarget metrics;
};

// How the table's provenance says that it was fitted; the default fitter where it does not say, or says what
// no option allows (a damaged file). A stochastic descent takes too long here: the same distance without it.
TableFitOptions fitOptionsOf(const Table& table, std::uint64_t seed) {
  const auto& known = table.info().provenance.options;
  const auto text = [&](std::string_view name) -> std::string {
    for (const auto& [key, value] : known)
      if (key == name && std::holds_alternative<std::string>(value)) return std::get<std::string>(value);
    return {};
  };
  const auto number = [&](std::string_view name, double otherwise) {
    for (const auto& [key, value] : known) {
      if (key != name) continue;
      if (std::holds_alternative<double>(value)) return std::get<double>(value);
      if (std::holds_alternative<std::int64_t>(value))
        return static_cast<double>(std::get<std::int64_t>(value));
    }
    return otherwise;
  };
  const std::string given = text("preset");
  const std::string preset = given == "fast" || given == "fine" ? given : "standard";
  const std::string fitter = text("fitter");
  TableFitOptions o;
  o.fitter = fitter == "light" ? Fitter::kLight : fitter == "l3" ? Fitter::kL3 : Fitter::kSlicedWasserstein;
  o.sw = slicedWassersteinPreset(preset);
  o.light = lightFitPreset(preset);
  const TableFitOptions standard = o;
  o.sw.leakWeight = number("leak_weight", 0.0);
  o.light.leakWeight = number("leak_weight", o.light.leakWeight);
  PolygonLightOptions& lights = o.light.lights;
  lights.sizeExponent = number("size_exponent", lights.sizeExponent);
  lights.lights = static_cast<int>(std::clamp(number("lights", lights.lights), 0.0, 1e6));
  for (const LightWeighting w : {LightWeighting::kRelative, LightWeighting::kMixed})
    if (text("weighting") == lightWeightingName(w)) lights.weighting = w;
  std::string error;
  if (!o.isValid(&error)) {
    o.sw = standard.sw;
    o.light = standard.light;
  }
  o.sw.seed = o.light.lights.seed = o.l3.seed = seed;
  if (text("family") == "3") o.l3.family = IsotropicFamily::kMeanFrame3;
  return o;
}

// A fit of the very point, of the table's own kind: its error at a node is then no cost of interpolation.
// Isotropic tables that do not say how they were fitted are taken for L3 ones: the published one is.
Matrix3d directFit(const Matrix3d& fetched, const Table& table, const Target& target,
                   const TableFitOptions& options) {
  if (table.isIsotropic() && (options.fitter == Fitter::kL3 || table.info().provenance.options.empty()))
    return fitIsotropicEntry(*target.lobe, target.metrics.moments(), fetched, options.l3).m;
  return fitJob({target.parameters, familyOf(target.parameters)}, table.info().brdf, options).m;
}

PointResult judge(const TableEntry& entry, const Table& table, const Target& target,
                  const ScoreOptions& options) {
  PointResult out;
  out.parameters = target.parameters;
  out.singular = !entry.invertible;
  out.singularFloat32 =
      out.singular || !isInvertibleInFloat(table.info().stores == MatrixStorage::kM ? entry.m : entry.mInv);
  if (out.singular) {
    for (std::size_t m = 0; m < kMetricCount; ++m) out.metrics.set(static_cast<Metric>(m), std::nan(""));
    return out;
  }
  const Ltc ltc(entry.m);
  out.metrics = target.metrics.evaluate(ltc);
  addEntryErrors(entry, table.info().stores, target.metrics.moments(), out.metrics);
  if (options.interpolation) {
    const Matrix3d direct =
        directFit(entry.m, table, target, fitOptionsOf(table, mixSeed(options.metrics.seed, 21)));
    out.metrics.set(Metric::kInterpolationRatio,
                    out.metrics.get(Metric::kSw1) / target.metrics.sw1(Ltc(direct)));
  }
  return out;
}

}  // namespace

std::vector<Score> scoreTables(const std::vector<const Table*>& tables, const ScoreOptions& options,
                               const ScoreProgress& progress) {
  const Table& first = *tables.at(0);
  for (const Table* table : tables) {
    if (table->isIsotropic() != first.isIsotropic()) {
      abortWith("scoreTables: an isotropic and an anisotropic table have no points in common");
    }
  }
  const std::vector<Point> points =
      makePoints(first, options.set, options.count, options.minAlpha, options.metrics.seed);
  std::vector<std::vector<PointResult>> results(tables.size(), std::vector<PointResult>(points.size()));
  std::size_t done = 0;
  parallelFor(points.size(), {.threads = options.threads}, [&](std::size_t i) {
    // Lights, directions and samples of its own for each point: their noise then averages out over the table.
    ScoreOptions own = options;
    own.metrics.seed = mixSeed(options.metrics.seed, 1000 + i);
    const Target target(first.info().brdf, points[i].parameters, own.metrics);
    for (std::size_t t = 0; t < tables.size(); ++t) {
      const Table& table = *tables[t];
      if (points[i].node && sameLayout(first, table)) {
        const std::vector<std::size_t> node = table.node(*points[i].node);
        const LobeParameters fitted = table.parameters(node);
        const bool same = sameParameters(fitted, points[i].parameters);
        results[t][i] =
            same ? judge(table.entry(node), table, target, own)
                 : judge(table.entry(node), table, Target(table.info().brdf, fitted, own.metrics), own);
        results[t][i].otherParameters = !same;
      } else {
        results[t][i] = judge(table.fetch(points[i].parameters), table, target, own);
      }
    }
    return [&] {
      if (progress) progress(++done, points.size());
    };
  });

  std::vector<Score> scores(tables.size());
  for (std::size_t t = 0; t < tables.size(); ++t) {
    Score& score = scores[t];
    score.points = points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PointResult& r = results[t][i];
      score.all.push_back({r.parameters, r.metrics});
      score.singular += r.singular ? 1 : 0;
      score.otherParameters += r.otherParameters ? 1 : 0;
      score.singularFloat32 += r.singularFloat32 ? 1 : 0;
    }
    for (std::size_t m = 0; m < kMetricCount; ++m) {
      std::vector<double> values;
      for (const PointResult& r : results[t]) {
        if (r.metrics.present[m] && !r.singular) values.push_back(r.metrics.value[m]);
      }
      // a singular entry is a fault of every metric that the others have
      score.present[m] = !values.empty();
      if (score.present[m]) values.resize(values.size() + score.singular, std::nan(""));
      score.summary[m] = summarize(std::move(values));
    }
  }
  return scores;
}

}  // namespace ltcfit
