// Everything that `ltcfit report` says about one table, held against others of its kind.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "report/histogram.h"
#include "report/lobe_images.h"
#include "report/score.h"
#include "report/smoothness.h"
#include "report/verdicts.h"

namespace ltcfit {

struct ReportOptions {
  MetricOptions metrics;
  std::size_t points = 512;  ///< of each of the sets off-grid and extreme; nodes are all taken
  int threads = 0;           ///< 0: as many as OpenMP offers
};

struct ReportHistogram {
  PointSet set = PointSet::kNodes;
  Metric metric = Metric::kSw1Rel;
  LogHistogram histogram;  ///< a series for each table
};

struct ReportLobe {
  std::string why;
  std::size_t node = 0;
  LobeParameters parameters;
  LobePictures pictures;
};

struct TableReport {
  std::vector<ScoredSet> sets;  ///< nodes, off-grid, extreme
  std::vector<ReportHistogram> histograms;
  std::vector<std::vector<AxisSmoothness>> smoothness;  ///< of each table, at its own nodes
  std::vector<ReportLobe> lobes;
  std::vector<Verdict> verdicts;
};

/// What is drawn as a histogram.
inline constexpr std::array kHistogramMetrics{Metric::kSw1Rel, Metric::kForm,   Metric::kLightS,
                                              Metric::kLightM, Metric::kLightL, Metric::kTv,
                                              Metric::kBelow};

/// The reported table first, then those it is held against, all of one kind. The result does not depend on
/// threads.
TableReport reportTable(const std::vector<ReportTable>& tables, const ReportOptions& options,
                        const ScoreProgress& progress = {});

}  // namespace ltcfit
