#include "export/reading_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "export/direction_moments.h"
#include "export/reading_limits.h"
#include "export/readings.h"

namespace ltcfit {
namespace {

// Nodes along each axis, ends included.
constexpr std::size_t kIsotropicNodes = 8;
constexpr std::size_t kAnisotropicNodes = 4;
// Published tables are right at most nodes and far off at some grazing ones.
constexpr double kKept = 0.75;
constexpr int kMostChanges = 3;
// Differences below are noise of the moments, or of a fit.
constexpr double kNotableMisfit = 0.01;
constexpr double kAboutAsGood = 1.1;
constexpr double kNoise = 0.002;
constexpr std::size_t kMostTold = 3;

std::vector<std::vector<std::size_t>> someNodes(const Table& table) {
  const std::size_t most = table.isIsotropic() ? kIsotropicNodes : kAnisotropicNodes;
  std::vector<std::vector<std::size_t>> out{{}};
  for (const Axis& axis : table.info().axes) {
    const std::size_t n = std::min(axis.size(), most);
    std::vector<std::vector<std::size_t>> longer;
    for (const std::vector<std::size_t>& node : out) {
      for (std::size_t i = 0; i < n; ++i) {
        longer.push_back(node);
        longer.back().push_back(n == 1 ? 0 : (i * (axis.size() - 1) + (n - 1) / 2) / (n - 1));
      }
    }
    out = std::move(longer);
  }
  return out;
}

// Arrangements have most lobes in common.
class GgxMomentsCache {
 public:
  const DirectionMoments& operator()(const LobeParameters& p) {
    const auto [found, isNew] = shapes_.try_emplace({p.alphaX, p.alphaY, p.theta, p.phi});
    if (isNew) found->second = ggxMoments(p).lobe;
    return found->second;
  }

 private:
  std::map<std::array<double, 4>, DirectionMoments> shapes_;
};

double meanOfBetter(std::vector<double> distances) {
  const auto kept = static_cast<std::size_t>(std::ceil(kKept * static_cast<double>(distances.size())));
  std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(kept - 1),
                   distances.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < kept; ++i) sum += distances[i];
  return sum / static_cast<double>(kept);
}

std::vector<ReadingFit> fitsOf(const Table& table, const std::vector<Arrangement>& arrangements,
                               const std::vector<MatrixReading>& matrices, int mostChanges) {
  const std::vector<std::vector<std::size_t>> nodes = someNodes(table);
  std::vector<std::vector<DirectionMoments>> shapes(matrices.size());
  for (std::size_t m = 0; m < matrices.size(); ++m) {
    for (const std::vector<std::size_t>& node : nodes)
      shapes[m].push_back(ltcMoments(matrices[m].m(table.entry(node))));
  }
  GgxMomentsCache ggx;
  std::vector<ReadingFit> out;
  for (const Arrangement& arrangement : arrangements) {
    std::vector<DirectionMoments> lobes;
    for (const std::vector<std::size_t>& node : nodes)
      lobes.push_back(ggx(parametersOf(arrangement, node, table.info().alphaFloor)));
    for (std::size_t m = 0; m < matrices.size(); ++m) {
      ReadingFit fit{arrangement.name, arrangement.changes + matrices[m].changes, 0.0};
      if (fit.changes > mostChanges) continue;
      if (!matrices[m].name.empty()) fit.name += (fit.name.empty() ? "" : ", ") + matrices[m].name;
      std::vector<double> distances;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        distances.push_back(momentDistance(shapes[m][i], lobes[i]));
      fit.misfit = meanOfBetter(std::move(distances));
      out.push_back(std::move(fit));
    }
  }
  return out;
}

// Several combinations can mean the same numbers.
ReadingFit simplestOfBest(const std::vector<ReadingFit>& fits) {
  double least = INFINITY;
  for (const ReadingFit& fit : fits) least = std::min(least, fit.misfit);
  const ReadingFit* simplest = nullptr;
  for (const ReadingFit& fit : fits) {
    if (fit.misfit > kAboutAsGood * least + kNoise) continue;
    if (simplest == nullptr || fit.changes < simplest->changes ||
        (fit.changes == simplest->changes && fit.misfit < simplest->misfit))
      simplest = &fit;
  }
  return simplest == nullptr ? ReadingFit{"", 0, INFINITY} : *simplest;
}

}  // namespace

std::vector<ReadingFit> readingFits(const Table& table) {
  return fitsOf(table, arrangementsOf(table), matrixReadingsOf(table), kMostChanges);
}

double misfitOf(const Table& table) {
  return fitsOf(table, {arrangementsOf(table).front()}, {matrixReadingsOf(table).front()}, 0).front().misfit;
}

bool ReadingVerdict::isBetter() const {
  return misfit > kClearlyBetter * best.misfit && misfit > best.misfit + kNotableMisfit;
}

std::vector<std::string> ReadingVerdict::complaints() const {
  std::vector<std::string> out;
  if (isBetter())
    out.push_back(fmt::format("read with {} it fits {:.1f} times better ({:.3f} against {:.3f})", best.name,
                              misfit / best.misfit, best.misfit, misfit));
  for (std::size_t i = 0; i < std::min(broken.size(), kMostTold); ++i)
    out.push_back("limit of GGX tables not kept: " + broken[i]);
  if (broken.size() > kMostTold)
    out.push_back(fmt::format("{} more limits are not kept", broken.size() - kMostTold));
  return out;
}

ReadingVerdict judgeReading(const Table& table) {
  ReadingVerdict verdict;
  if (table.info().brdf != "ggx") return verdict;
  const std::vector<ReadingFit> fits = readingFits(table);
  verdict.misfit = fits.front().misfit;
  verdict.best = simplestOfBest({fits.begin() + 1, fits.end()});
  verdict.broken = brokenLimits(table, someNodes(table));
  return verdict;
}

}  // namespace ltcfit
