#include "report/score.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/diagnostics.h"
#include "base/parallel_for.h"
#include "fit/memory_estimate.h"
#include "fit/target_lobe.h"
#include "report/direct_fit.h"

namespace ltcfit {
namespace {

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

PointResult judge(const TableEntry& entry, const Table& table, const Target& target,
                  const DirectFit* direct) {
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
  if (direct != nullptr) {
    const std::optional<Eigen::Matrix3d> m =
        (*direct)(target.parameters, *target.lobe, target.metrics.moments(), entry.m);
    out.metrics.set(Metric::kInterpolationRatio,
                    m ? out.metrics.get(Metric::kSw1) / target.metrics.sw1(Ltc(*m)) : std::nan(""));
  }
  return out;
}

}  // namespace

// Numbers are differences of the peak resident set over sizes.
double scoreBytes(const Table& first, std::size_t tables, const ScoreOptions& options) {
  const std::size_t nodes = first.nodeCount();
  const bool all = options.set == PointSet::kNodes && (options.count == 0 || options.count > nodes);
  const std::size_t points = all ? nodes : options.count;
  const int threads = threadCount(options.threads);
  const MetricOptions& m = options.metrics;
  const double lights = static_cast<double>(m.quads) + 3.0 * m.lights;
  double ofThread = m.samples * (110.0 + 15.2 * m.directions) + 158.0 * lights;
  double bytes = static_cast<double>(points) * (64.0 + 350.0 * static_cast<double>(tables));
  if (options.interpolation) {
    const FitRecipe recipe = fitFromProvenance(first.info()).recipe;
    ofThread += lobeFitBytes(recipe.fit, recipe.kind);
    bytes += static_cast<double>(nodes) * nodeFitBytes(recipe.kind);
  }
  return bytes + std::min(static_cast<double>(threads), static_cast<double>(points)) * ofThread;
}

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
  std::vector<std::unique_ptr<const DirectFit>> directs(tables.size());
  for (std::size_t t = 0; options.interpolation && t < tables.size(); ++t)
    directs[t] = std::make_unique<DirectFit>(*tables[t], options.threads);
  std::vector<std::vector<PointResult>> results(tables.size(), std::vector<PointResult>(points.size()));
  std::size_t done = 0;
  parallelFor(points.size(), {.threads = options.threads}, [&](std::size_t i) {
    // Lights, directions and samples of its own for each point: their noise then averages out over the table.
    ScoreOptions own = options;
    own.metrics.seed = mixSeed(options.metrics.seed, 1000 + i);
    const Target target(first.info().brdf, points[i].parameters, own.metrics);
    for (std::size_t t = 0; t < tables.size(); ++t) {
      const Table& table = *tables[t];
      const DirectFit* const direct = directs[t].get();
      if (points[i].node && sameLayout(first, table)) {
        const std::vector<std::size_t> node = table.node(*points[i].node);
        const LobeParameters fitted = table.parameters(node);
        const bool same = sameParameters(fitted, points[i].parameters);
        results[t][i] =
            same ? judge(table.entry(node), table, target, direct)
                 : judge(table.entry(node), table, Target(table.info().brdf, fitted, own.metrics), direct);
        results[t][i].otherParameters = !same;
      } else {
        results[t][i] = judge(table.fetch(points[i].parameters), table, target, direct);
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
    if (directs[t]) score.notes = directs[t]->notes();
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
