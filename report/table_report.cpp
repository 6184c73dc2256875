#include "report/table_report.h"

#include "base/parallel_for.h"
#include "report/lobe_choice.h"

namespace ltcfit {
namespace {

std::vector<double> valuesOf(const Score& score, Metric metric) {
  std::vector<double> out;
  for (const PointScore& point : score.all) {
    if (point.metrics.present[static_cast<std::size_t>(metric)]) out.push_back(point.metrics.get(metric));
  }
  return out;
}

std::vector<ReportHistogram> histogramsOf(const std::vector<ScoredSet>& sets) {
  std::vector<ReportHistogram> out;
  for (const ScoredSet& set : sets) {
    for (const Metric metric : kHistogramMetrics) {
      std::vector<std::vector<double>> values;
      for (const Score& score : set.scores) values.push_back(valuesOf(score, metric));
      out.push_back({set.set, metric, logHistogram(values)});
    }
  }
  return out;
}

std::vector<ReportLobe> drawLobes(const std::vector<ReportTable>& tables, const Score& nodes, int threads) {
  const Table& first = tables[0].read;
  const std::vector<ChosenLobe> chosen = chooseLobes(first, nodes);
  std::vector<ReportLobe> out(chosen.size());
  parallelFor(chosen.size(), {.threads = threads}, [&](std::size_t i) {
    const std::vector<std::size_t> node = first.node(chosen[i].node);
    const LobeParameters p = first.parameters(node);
    std::vector<TableEntry> entries{first.entry(node)};
    for (std::size_t t = 1; t < tables.size(); ++t) entries.push_back(tables[t].read.fetch(p));
    out[i] = {chosen[i].why, chosen[i].node, p, drawLobe(first.info().brdf, p, entries)};
  });
  return out;
}

}  // namespace

TableReport reportTable(const std::vector<ReportTable>& tables, const ReportOptions& options,
                        const ScoreProgress& progress) {
  std::vector<const Table*> read;
  read.reserve(tables.size());
  for (const ReportTable& table : tables) read.push_back(&table.read);
  const std::size_t nodes = read[0]->nodeCount();
  const std::size_t total = nodes + 2 * options.points;
  TableReport out;
  std::size_t before = 0;
  for (const PointSet set : {PointSet::kNodes, PointSet::kOffGrid, PointSet::kExtreme}) {
    ScoreOptions score;
    score.set = set;
    score.count = set == PointSet::kNodes ? 0 : options.points;
    score.metrics = options.metrics;
    score.threads = options.threads;
    out.sets.push_back({set, scoreTables(read, score, [&](std::size_t done, std::size_t) {
                          if (progress) progress(before + done, total);
                        })});
    before += set == PointSet::kNodes ? nodes : options.points;
  }
  out.histograms = histogramsOf(out.sets);
  for (const Table* table : read) out.smoothness.push_back(tableSmoothness(*table, options.threads));
  out.lobes = drawLobes(tables, out.sets[0].scores[0], options.threads);
  out.verdicts = tableVerdicts(tables, out.sets);
  return out;
}

}  // namespace ltcfit
