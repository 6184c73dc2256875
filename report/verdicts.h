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

/// The ratio of two means over the same points, and its standard error from how far the pairs scatter about
/// it.
struct MeanRatio {
  double ratio = 0.0;  ///< NaN without a pair or where the second mean is not above 0
  double standardError = 0.0;
  std::size_t points = 0;  ///< pairs of finite values
};

/// ratio = mean a / mean b and sd(a_i - ratio b_i) / (sqrt(n) mean b) (the delta method; n - 1 in sd), over
/// the pairs that are both finite; 0 of a single pair, whose scatter is unknown. Both of one size.
MeanRatio ratioOfMeans(const std::vector<double>& a, const std::vector<double>& b);

/// Of tables[0]: usable everywhere (inverses in float32, det M > 0, fetched matrices), norm, Fresnel and
/// determinant to 1e-3, half precision within 0.05 rad; and for each other table the ratios of the mean
/// errors, of what a renderer fetches (off-grid), to be at most 1 and two of the ratio's standard errors, so
/// that equal tables pass whatever the seed. NaN, which fails, where this table's error is missing at a
/// point. `sets` holds all three point sets.
std::vector<Verdict> tableVerdicts(const std::vector<ReportTable>& tables,
                                   const std::vector<ScoredSet>& sets);

}  // namespace ltcfit
