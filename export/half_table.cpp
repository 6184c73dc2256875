#include "export/half_table.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include "base/parallel_for.h"
#include "base/refusal.h"
#include "export/half_matrix.h"

namespace ltcfit {
namespace {

constexpr double kSmallestNormalHalf = 6.103515625e-5;
constexpr double kLargestHalfEntry = 65504.0;
constexpr double kNotableShift = 0.05;  // rad

// The matrices of the nodes one step away along each axis.
std::vector<Eigen::Matrix3d> neighboursOf(const Table& table, const std::vector<Eigen::Matrix3d>& matrices,
                                          std::size_t flat, double scale) {
  std::vector<Eigen::Matrix3d> out;
  const std::vector<std::size_t> node = table.node(flat);
  std::size_t stride = table.nodeCount();
  for (std::size_t a = 0; a < node.size(); ++a) {
    stride /= table.info().axes[a].size();
    if (node[a] > 0) out.push_back(scale * matrices[flat - stride]);
    if (node[a] + 1 < table.info().axes[a].size()) out.push_back(scale * matrices[flat + stride]);
  }
  return out;
}

double smallerAlpha(const Table& table, std::size_t node) {
  const LobeParameters p = table.parameters(table.node(node));
  return std::min(p.alphaX, p.alphaY);
}

}  // namespace

double halfScale(const std::vector<Eigen::Matrix3d>& matrices) {
  double smallest = kSmallestNormalHalf;
  double largest = 0.0;
  for (const Eigen::Matrix3d& m : matrices) {
    smallest = std::min(smallest, m.diagonal().cwiseAbs().minCoeff());
    largest = std::max(largest, m.cwiseAbs().maxCoeff());
  }
  double scale = 1.0;
  while (smallest * scale < kSmallestNormalHalf && 2.0 * largest * scale <= kLargestHalfEntry) scale *= 2.0;
  return scale;
}

std::string placeOf(const Table& table, std::size_t node) {
  const LobeParameters p = table.parameters(table.node(node));
  return fmt::format("the node at alpha {:.6g}, theta {:.2f} degrees", p.alphaX,
                     p.theta * 180.0 / std::numbers::pi);
}

std::optional<std::string> warningOf(const HalfReport& report) {
  if (!(report.largestShift > kNotableShift)) return std::nullopt;
  return fmt::format(
      "half precision moves a lobe by {:.3f} rad (--report shows where): write floats, or fit with a larger "
      "--alpha-floor",
      report.largestShift);
}

HalfReport roundMatrices(const Table& table, std::vector<Eigen::Matrix3d>& matrices, MatrixStorage stores,
                         const std::array<bool, 9>& free, double scale) {
  // tables hold equal matrices (at alpha 0 for every lambda), and some take long
  std::map<std::vector<double>, std::size_t> firstOf;
  std::vector<std::size_t> source(matrices.size());
  std::vector<std::size_t> different;
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    const auto [found, isNew] = firstOf.try_emplace({matrices[i].data(), matrices[i].data() + 9}, i);
    source[i] = found->second;
    if (isNew) different.push_back(i);
  }
  std::vector<HalfRounding> roundings(matrices.size());
  parallelFor(different.size(), {.chunk = 4}, [&](std::size_t k) {
    const std::size_t i = different[k];
    try {
      roundings[i] = roundToHalf(scale * matrices[i], stores, free, neighboursOf(table, matrices, i, scale));
    } catch (const Refusal& error) {
      throw Refusal(
          fmt::format("{} {}; fit with a larger --alpha-floor, or write floats where there is a choice",
                      placeOf(table, i), error.what()));
    }
  });

  HalfReport report;
  double beyond = 0.0;
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    const HalfRounding& rounding = roundings[source[i]];
    matrices[i] = rounding.matrix;
    const Eigen::Matrix3d m =
        stores == MatrixStorage::kM ? rounding.matrix : rounding.matrix.inverse().eval();
    report.nodes.push_back({i, rounding.shift, rounding.detError, rounding.constrained, rounding.moved, m});
    report.moved += rounding.moved ? 1 : 0;
    report.constrained += rounding.constrained ? 1 : 0;
    report.largestShift = std::max(report.largestShift, rounding.between);
    if (!(rounding.detError <= kHalfDeterminantLimit)) {
      ++report.beyond;
      beyond = std::max(beyond, smallerAlpha(table, i));
    }
  }
  report.alphaFloor = std::numeric_limits<double>::infinity();
  for (const HalfNode& node : report.nodes) {
    const double alpha = smallerAlpha(table, node.node);
    if (alpha <= beyond) continue;
    report.alphaFloor = std::min(report.alphaFloor, alpha);
    report.largestDetError = std::max(report.largestDetError, node.detError);
  }
  return report;
}

}  // namespace ltcfit
