// What the fits of tables print about the result: times and errors on unseen samples.
#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/fit_arguments.h"
#include "report/score.h"

namespace ltcfit::app {

struct Times {
  double cpu = 0.0;   ///< seconds, all threads
  double wall = 0.0;  ///< seconds
};

/// CPU and wall time since it was made.
class Stopwatch {
 public:
  Stopwatch();
  Times elapsed() const;

 private:
  double cpu_;
  double wall_;
};

/// Scores the table off-grid on samples the fit has not seen; null where the arguments ask for none. An
/// isotropic table is read as its header is: shaders interpolate the inverse.
std::unique_ptr<Score> scoreFit(const Table& table, const FitArguments& a);

/// What a look-up of the table costs a shader that has the table's own look-up (export --format glsl-lookup):
/// its size as --layout lean in halves, and its fetches. What it computes besides: check-gl --cost.
struct LookupSummary {
  std::size_t bytes = 0;
  int fetches = 0;
  std::string refusal;  ///< why there is no such look-up; empty where there is one
};
LookupSummary summarizeLookup(const TableInfo& info);
void printLookup(const LookupSummary& lookup);
/// Adds "lookup".
void addLookup(const LookupSummary& lookup, nlohmann::ordered_json* out);

void printScore(const Score& score, const FitArguments& a);
/// Adds "off_grid".
void addScore(const Score& score, nlohmann::ordered_json* out);

}  // namespace ltcfit::app
