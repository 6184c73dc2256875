// A table against stated limits.
#pragma once

#include <string>
#include <vector>

#include "ltc/table.h"
#include "report/score.h"

namespace ltcfit {

/// A table of the report, and what a shader interpolates of it.
struct ReportTable {
  std::string name;
  Table file;  ///< as the file holds it
  Table read;  ///< as it is judged between nodes (storedAs), or the same
};

/// Scores of all tables at one set of points: the reported table first, then those it is held against.
struct ScoredSet {
  PointSet set = PointSet::kNodes;
  std::vector<Score> scores;
};

/// Passes where value <= limit.
struct Verdict {
  std::string what;
  double value = 0.0;  ///< NaN where it cannot be had: does not pass
  double limit = 0.0;
  std::string detail;  ///< a sentence, or nothing

  bool passes() const { return value <= limit; }
};

/// Of tables[0]: usable everywhere (inverses in float32, det M > 0, fetched matrices), norm, Fresnel and
/// determinant to 1e-3, half precision within 0.05 rad; and for each other table the ratios of the mean
/// errors, of what a renderer fetches (off-grid), to be at most 1. `sets` holds all three point sets.
std::vector<Verdict> tableVerdicts(const std::vector<ReportTable>& tables,
                                   const std::vector<ScoredSet>& sets);

}  // namespace ltcfit
