// Scores tables against the lobes they stand for.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "report/metrics.h"
#include "report/points.h"
#include "report/statistics.h"

namespace ltcfit {

struct ScoreOptions {
  PointSet set = PointSet::kNodes;
  std::size_t count = 512;  ///< points; 0: all nodes
  double minAlpha = 0.0;    ///< leave out points with alpha below
  MetricOptions metrics;
  /// Also fit each point directly, as the table's provenance says it was fitted, for the ratio: DirectFit.
  bool interpolation = false;
  int threads = 0;  ///< 0: as many as OpenMP offers
};

struct PointScore {
  LobeParameters parameters;  ///< at which the table was judged
  EntryMetrics metrics;       ///< all NaN where the fetched matrix has no inverse
};

struct Score {
  std::array<Summary, kMetricCount> summary;
  std::array<bool, kMetricCount> present{};
  std::size_t points = 0;
  std::vector<PointScore> all;  ///< every point, in order
  std::size_t otherParameters =
      0;                     ///< nodes that this table has fitted at other parameters than the first one
  std::size_t singular = 0;  ///< fetched matrices without an inverse: all metrics of these points are missing
  std::size_t singularFloat32 = 0;  ///< without a usable inverse in float32
  std::vector<std::string> notes;   ///< DirectFit::notes
};

/// Called after each finished point, never from two threads at once.
using ScoreProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Estimated bytes that scoreTables takes for `tables` tables of which the first is `first`, within a factor
/// of 1.5 where they are more than some 20 MB (tests/app/memory.sh).
double scoreBytes(const Table& first, std::size_t tables, const ScoreOptions& options);

/// Scores every table at the same points, those of the first one. At nodes a table with the same number of
/// nodes on the same axes is judged node by node, each at the parameters it was fitted with (published tables
/// clamp theta and alpha at other values than ours); any other table is fetched at the first one's
/// parameters. All tables must be isotropic or all anisotropic. The result does not depend on the number of
/// threads.
std::vector<Score> scoreTables(const std::vector<const Table*>& tables, const ScoreOptions& options,
                               const ScoreProgress& progress = {});

}  // namespace ltcfit
