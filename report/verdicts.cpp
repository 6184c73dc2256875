#include "report/verdicts.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/refusal.h"
#include "export/packing.h"
#include "export/reading_verdict.h"

namespace ltcfit {
namespace {

// Norm and Fresnel scale what is seen: a thousandth is a quarter of a step of an 8-bit display.
constexpr double kAmplitudeLimit = 1e-3;
// Likewise of a determinant, by which a polygon's integral is scaled where engines multiply by it.
constexpr double kDeterminantLimit = 1e-3;
// Above it export warns too (export/half_table.h).
constexpr double kHalfShiftLimit = 0.05;
// One table in forty that is as good as the other fails by the draw of the points.
constexpr double kStandardErrors = 2.0;

const ScoredSet& of(const std::vector<ScoredSet>& sets, PointSet set) {
  return *std::find_if(sets.begin(), sets.end(), [&](const ScoredSet& s) { return s.set == set; });
}

std::size_t index(Metric metric) {
  return static_cast<std::size_t>(metric);
}

// Largest value over the points, NaN where one of them is not finite.
double largest(const Score& score, Metric metric) {
  const Summary& s = score.summary[index(metric)];
  return s.nonFinite > 0 || s.count == 0 ? std::nan("") : s.max;
}

Verdict usableNodes(const Score& nodes) {
  // those without an inverse in double are among those without one in float32
  Verdict v{"Nodes without an inverse in float32", static_cast<double>(nodes.singularFloat32), 0.0, {}};
  v.detail = fmt::format("of {} nodes", nodes.points);
  return v;
}

Verdict orientation(const Table& table) {
  std::size_t turned = 0;
  for (std::size_t i = 0; i < table.nodeCount(); ++i)
    turned += table.entry(table.node(i)).m.determinant() > 0.0 ? 0 : 1;
  return {"Nodes where det M is not above 0", static_cast<double>(turned), 0.0,
          "A lobe of negative determinant reverses the winding of lights."};
}

Verdict fetched(const std::vector<ScoredSet>& sets) {
  std::size_t bad = 0;
  std::size_t points = 0;
  for (const ScoredSet& s : sets) {
    if (s.set == PointSet::kNodes) continue;
    bad += s.scores[0].singularFloat32;
    points += s.scores[0].points;
  }
  return {"Fetched matrices without an inverse in float32, off-grid and extreme", static_cast<double>(bad),
          0.0, fmt::format("of {} points", points)};
}

Verdict determinants(const std::vector<ScoredSet>& sets) {
  Verdict v{"Determinant of the shader's inverse, largest relative error at all points", 0.0,
            kDeterminantLimit, ""};
  std::size_t above = 0;
  std::size_t points = 0;
  for (const ScoredSet& s : sets) {
    const double error = largest(s.scores[0], Metric::kDetError);
    v.value = std::isnan(error) || std::isnan(v.value) ? std::nan("") : std::max(v.value, error);
    points += s.scores[0].points;
    for (const PointScore& point : s.scores[0].all)
      above += point.metrics.get(Metric::kDetError) <= kDeterminantLimit ? 0 : 1;
  }
  v.detail =
      fmt::format("float32 arithmetic against double; above the limit at {} of {} points", above, points);
  return v;
}

// Whether the numbers are what the table says that they are.
void addReading(const Table& table, std::vector<Verdict>& out) {
  if (table.info().brdf != "ggx") return;
  const ReadingVerdict reading = judgeReading(table);
  const double ratio = reading.misfit > 0.0 ? reading.misfit / reading.best.misfit : 0.0;
  out.push_back({"Misfit as read, over the best other reading's",
                 reading.isBetter() ? ratio : std::min(ratio, kClearlyBetter), kClearlyBetter,
                 fmt::format("read with {}: {:.3f} against {:.3f}", reading.best.name, reading.best.misfit,
                             reading.misfit)});
  out.push_back({"Limits of every GGX table that are broken", static_cast<double>(reading.broken.size()), 0.0,
                 fmt::format("{}", fmt::join(reading.broken, "; "))});
}

Verdict halves(const Table& table) {
  Verdict v{"Half precision: largest shift of a lobe, rad", std::nan(""), kHalfShiftLimit, {}};
  try {
    const HalfReport report =
        pack(table, table.isIsotropic() ? packing2017() : packingOfRows(), Precision::kHalf).half;
    v.value = report.largestShift;
    v.detail = table.isIsotropic() ? "the inverse over its middle element, as in the layout of 2017"
                                   : "M, times a power of two";
  } catch (const Refusal& error) {
    v.detail = error.what();
  }
  return v;
}

std::vector<double> allValuesOf(const Score& score, Metric metric) {
  std::vector<double> out;
  out.reserve(score.all.size());
  for (const PointScore& point : score.all) out.push_back(point.metrics.get(metric));
  return out;
}

Verdict comparison(const Score& ours, const Score& theirs, Metric metric, const std::string& name) {
  Verdict v{fmt::format("Mean {} off-grid over that of {}", metricName(metric), name), std::nan(""), 1.0, {}};
  if (ours.summary[index(metric)].nonFinite > 0) return v;
  const MeanRatio r = ratioOfMeans(allValuesOf(ours, metric), allValuesOf(theirs, metric));
  v.value = r.ratio;
  if (std::isnan(r.ratio)) return v;
  v.limit = 1.0 + kStandardErrors * r.standardError;
  v.detail = fmt::format("1 and two standard errors, {:.2g} each, over {} points", r.standardError, r.points);
  return v;
}

}  // namespace

MeanRatio ratioOfMeans(const std::vector<double>& a, const std::vector<double>& b) {
  MeanRatio out;
  double sumA = 0.0;
  double sumB = 0.0;
  const auto finite = [&](std::size_t i) { return std::isfinite(a[i]) && std::isfinite(b[i]); };
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!finite(i)) continue;
    ++out.points;
    sumA += a[i];
    sumB += b[i];
  }
  out.ratio = sumB > 0.0 ? sumA / sumB : std::nan("");
  if (out.points < 2 || std::isnan(out.ratio)) return out;
  // the differences' mean is 0 by the choice of the ratio
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (finite(i)) squares += (a[i] - out.ratio * b[i]) * (a[i] - out.ratio * b[i]);
  const double n = static_cast<double>(out.points);
  out.standardError = std::sqrt(squares / (n - 1.0) / n) / (sumB / n);
  return out;
}

std::vector<Verdict> tableVerdicts(const std::vector<ReportTable>& tables,
                                   const std::vector<ScoredSet>& sets) {
  const Score& nodes = of(sets, PointSet::kNodes).scores[0];
  std::vector<Verdict> out{usableNodes(nodes), orientation(tables[0].file), fetched(sets)};
  if (nodes.present[index(Metric::kAlbedoError)])
    out.push_back(
        {"Norm, largest error at nodes", largest(nodes, Metric::kAlbedoError), kAmplitudeLimit, {}});
  if (nodes.present[index(Metric::kFresnelError)])
    out.push_back(
        {"Fresnel, largest error at nodes", largest(nodes, Metric::kFresnelError), kAmplitudeLimit, {}});
  out.push_back(determinants(sets));
  out.push_back(halves(tables[0].file));
  addReading(tables[0].file, out);
  constexpr std::array kCompared{Metric::kLightS, Metric::kLightM, Metric::kLightL, Metric::kForm,
                                 Metric::kTv,     Metric::kBelow,  Metric::kSw1};
  const std::vector<Score>& offGrid = of(sets, PointSet::kOffGrid).scores;
  for (std::size_t t = 1; t < tables.size(); ++t) {
    for (const Metric m : kCompared) out.push_back(comparison(offGrid[0], offGrid[t], m, tables[t].name));
  }
  return out;
}

}  // namespace ltcfit
