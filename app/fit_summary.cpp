#include "app/fit_summary.h"

#include <fmt/format.h>
#include <time.h>

#include <array>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "base/refusal.h"
#include "export/packing.h"
#include "export/shader_lookup.h"

namespace ltcfit::app {
namespace {

constexpr std::array<Metric, 7> kSummaryMetrics{Metric::kSw1,    Metric::kForm,   Metric::kLightS,
                                                Metric::kLightM, Metric::kLightL, Metric::kTv,
                                                Metric::kBelow};

double seconds(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

Stopwatch::Stopwatch() : cpu_(seconds(CLOCK_PROCESS_CPUTIME_ID)), wall_(seconds(CLOCK_MONOTONIC)) {}

Times Stopwatch::elapsed() const {
  return {seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu_, seconds(CLOCK_MONOTONIC) - wall_};
}

std::unique_ptr<Score> scoreFit(const Table& table, const FitArguments& a) {
  if (a.scorePoints == 0 || (a.quiet && !a.json)) return nullptr;
  ScoreOptions scoring;
  scoring.set = PointSet::kOffGrid;
  scoring.count = static_cast<std::size_t>(a.scorePoints);
  scoring.metrics.seed = static_cast<std::uint64_t>(a.seed) + 1;
  scoring.threads = a.threads;
  if (!table.isIsotropic()) return std::make_unique<Score>(scoreTables({&table}, scoring)[0]);
  const Table read = storedAs(table, MatrixStorage::kMinv, MatrixNormalization::kMiddleElement);
  return std::make_unique<Score>(scoreTables({&read}, scoring)[0]);
}

LookupSummary summarizeLookup(const TableInfo& info) {
  LookupSummary lookup;
  lookup.bytes = leanSize(info, Precision::kHalf).bytes;
  try {
    makeShaderLookup(info, ShadingLanguage::kGlsl, "ltc");
    lookup.fetches = fetchesOf(info);
  } catch (const Refusal& refusal) {
    lookup.refusal = refusal.what();
  }
  return lookup;
}

void printLookup(const LookupSummary& lookup) {
  fmt::print("as textures of halves (--layout lean) {} bytes; ", lookup.bytes);
  if (lookup.refusal.empty()) {
    fmt::print("its own look-up: {} fetch{}\n", lookup.fetches, lookup.fetches == 1 ? "" : "es");
  } else {
    fmt::print("no look-up of its own: {}\n", lookup.refusal);
  }
}

void addLookup(const LookupSummary& lookup, nlohmann::ordered_json* out) {
  nlohmann::ordered_json& json = (*out)["lookup"];
  json["bytes"] = lookup.bytes;
  if (lookup.refusal.empty()) {
    json["fetches"] = lookup.fetches;
  } else {
    json["refusal"] = lookup.refusal;
  }
}

void printScore(const Score& score, const FitArguments& a) {
  fmt::print("off-grid at {} points, fetched as shaders read {}, on unseen samples:\n", score.points,
             a.kind == FitKind::kIsotropic ? "the exported header" : "it");
  for (Metric m : kSummaryMetrics) {
    const Summary& s = score.summary[static_cast<std::size_t>(m)];
    fmt::print("  {:<8} mean {:.5f}  p99 {:.5f}\n", metricName(m), s.mean, s.p99);
  }
}

void addScore(const Score& score, nlohmann::ordered_json* out) {
  for (Metric m : kSummaryMetrics) {
    const Summary& s = score.summary[static_cast<std::size_t>(m)];
    (*out)["off_grid"][metricName(m)] = {{"mean", s.mean}, {"p99", s.p99}};
  }
}

}  // namespace ltcfit::app
