// Whether a table is read right: do its matrices make GGX lobes where its axes say they are?
#pragma once

#include <string>
#include <vector>

#include "ltc/table.h"

namespace ltcfit {

/// How far the numbers, taken one way, are from the lobes.
struct ReadingFit {
  std::string name;     ///< as in "read with ..": "axes exchanged"; empty for the way that the table says
  int changes = 0;      ///< how many ways it differs from that
  double misfit = 0.0;  ///< mean of momentDistance over the better three quarters of up to 64 or 256 nodes
};

/// Every reading tried, the table's own first.
std::vector<ReadingFit> readingFits(const Table& table);

/// The misfit of the table as it says: 0 to 2.4, below 0.03 for every table fitted to GGX.
double misfitOf(const Table& table);

/// From so many times a better fit on, another reading counts as the right one: that of the published table
/// of 2017 with the axes of 2016 fits 2.0 times worse, and no fitted table has another reading that fits
/// better at all (tests/export/reading_verdict_test.cpp).
inline constexpr double kClearlyBetter = 1.6;

struct ReadingVerdict {
  double misfit = 0.0;              ///< as read
  ReadingFit best;                  ///< of the other readings, the simplest of those that fit about best
  std::vector<std::string> broken;  ///< limits of GGX tables (brokenLimits), a sentence each

  /// Whether the other reading fits clearly better.
  bool isBetter() const;
  bool passes() const { return !isBetter() && broken.empty(); }
  /// What is wrong, a sentence each; nothing where it passes.
  std::vector<std::string> complaints() const;
};

/// Takes under a second. Tables of other closures than GGX pass unseen.
ReadingVerdict judgeReading(const Table& table);

}  // namespace ltcfit
